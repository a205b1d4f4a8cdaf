/// The pattern of the normal equations of a graph and of their Cholesky factor: counts, and rasters
/// for a report.
///
/// Everything refers to the lower triangle, diagonal included, and to blocks: one row and column
/// per unknown vertex. H is symmetric, and the factor L has no other half.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <waymark/core/graph/graph.hpp>

namespace waymark::evaluation {

/// The size of a lower triangle.
struct TriangleCount {
  std::int64_t blocks = 0;
  /// numbers: n (n + 1) / 2 for a diagonal block, rows times columns for any other
  std::int64_t scalars = 0;
};

/// Nonzero blocks of a lower triangle, counted in square cells. Row r of the matrix is in row
/// floor(r cells / columns) of the raster.
struct DensityRaster {
  std::size_t columns = 0;  ///< block rows and columns of the matrix
  std::size_t cells = 0;    ///< cells per side; `columns` if that is at most the requested number
  /// cells x cells, row by row from the top; zero above the diagonal
  std::vector<std::uint32_t> count;

  [[nodiscard]] std::uint32_t at(std::size_t row, std::size_t column) const {
    return count[row * cells + column];
  }
  /// Returns how many blocks fit into a cell, on and below the diagonal: count / possible is
  /// its density.
  [[nodiscard]] std::int64_t possible(std::size_t row, std::size_t column) const;
};

struct Sparsity {
  std::string ordering;        ///< "natural", "leaves first", "amd" or "time" (Structure::ordering)
  std::size_t columns = 0;     ///< block columns: unknown vertices
  std::int64_t dimension = 0;  ///< scalar unknowns
  /// block columns that are ordered last because they touch very many edges
  std::size_t dense_columns = 0;
  TriangleCount matrix;         ///< of H
  TriangleCount factor;         ///< of L, without the zeros that solvers store for speed
  DensityRaster natural;        ///< H, vertices in the order of the graph
  DensityRaster ordered;        ///< H in the order of elimination of block_cholesky
  DensityRaster factor_raster;  ///< L in that order

  /// Returns numbers of L per number of H. 1: no fill. 0 without unknowns.
  [[nodiscard]] double fill_ratio() const;
};

/// Returns the pattern of the normal equations as `optimize` makes them (without vertices that are
/// held for the gauge), and of their factor. Chains are eliminated from both ends
/// (block_symbolic.hpp), so `ordered` may differ from the order of every file. Time and memory are
/// proportional to the blocks of L.
/// @param most_cells of a raster, per side; >= 1
/// @throws InputError if the gauge is undetermined (find_gauge); UsageError for no cells
[[nodiscard]] Sparsity sparsity_of(const Graph& graph, std::size_t most_cells = 200);

}  // namespace waymark::evaluation
