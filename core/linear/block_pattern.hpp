/// The block pattern of the normal matrix and its numbers, in the form that linear solvers need: no
/// graph, only blocks.
///
/// It is a plain value. Solvers read it only during analyze().
#pragma once

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include <waymark/core/base/export.hpp>

namespace WAYMARK_EXPORT waymark {

/// The upper block triangle of a symmetric matrix, by block columns in elimination order,
/// diagonal block last.
///
/// The numbers of block column j form one dense column-major panel at value[j] with height[j] rows.
/// It has the blocks in the order of their rows, and the whole diagonal block at the bottom. Read
/// as scalars, this is a compressed-column matrix; inside diagonal blocks its entries below the
/// diagonal mirror those above.
struct BlockPattern {
  std::vector<int> size;               ///< scalar columns of each block column
  std::vector<std::int64_t> start{0};  ///< first scalar column; size.size() + 1 entries
  /// begin of each block column in `row`; size.size() + 1 entries
  std::vector<std::int64_t> column{0};
  std::vector<int> row;                ///< block rows, ascending within a column
  std::vector<int> row_offset;         ///< first scalar row of the block within its panel
  std::vector<int> height;             ///< rows of each panel
  std::vector<std::int64_t> value{0};  ///< begin of each panel; size.size() + 1 entries
  /// changes with the pattern; the same version of one structure means the same pattern
  std::uint64_t version = 0;

  [[nodiscard]] int columns() const { return static_cast<int>(size.size()); }
  /// scalar rows and columns
  [[nodiscard]] std::int64_t dimension() const { return start.back(); }
  [[nodiscard]] std::int64_t value_count() const { return value.back(); }
};

/// The same pattern entry by entry: compressed columns with full diagonal blocks, upper triangle
/// of blocks. values[k] of the panels is the entry (row[k], column j) for column[j] <= k <
/// column[j + 1].
template <typename Index>
struct ScalarPattern {
  std::vector<Index> column;
  std::vector<Index> row;
};

template <typename Index>
[[nodiscard]] ScalarPattern<Index> to_scalar(const BlockPattern& pattern) {
  if (pattern.value_count() > std::numeric_limits<Index>::max()) {
    throw std::length_error("the normal equations have more numbers than this solver can index");
  }
  ScalarPattern<Index> scalar;
  scalar.column.reserve(static_cast<std::size_t>(pattern.dimension()) + 1);
  scalar.row.reserve(static_cast<std::size_t>(pattern.value_count()));
  scalar.column.push_back(0);
  for (std::size_t j = 0; j < pattern.size.size(); ++j) {
    for (int c = 0; c < pattern.size[j]; ++c) {
      for (auto k = pattern.column[j]; k < pattern.column[j + 1]; ++k) {
        const auto block_row = static_cast<std::size_t>(pattern.row[static_cast<std::size_t>(k)]);
        for (int r = 0; r < pattern.size[block_row]; ++r) {
          scalar.row.push_back(static_cast<Index>(pattern.start[block_row] + r));
        }
      }
      scalar.column.push_back(static_cast<Index>(scalar.row.size()));
    }
  }
  return scalar;
}

}  // namespace waymark
