/// Where the normal equations of a graph and their Cholesky factor have numbers: counts, and pictures as
/// coarse as a report needs them.
///
/// Everything is of the lower triangle, diagonal included, and in blocks: one row and column per unknown
/// vertex. H is symmetric, the factor L has no other half.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <waymark/core/graph/graph.hpp>

namespace waymark::evaluation {

/// How much a lower triangle holds.
struct TriangleCount {
  std::int64_t blocks = 0;
  std::int64_t scalars = 0;  ///< numbers: n (n + 1) / 2 of a diagonal block, rows times columns of any other
};

/// Nonzero blocks of a lower triangle, counted over square cells: row r of the matrix lies in row
/// floor(r cells / columns) of the raster.
struct DensityRaster {
  std::size_t columns = 0;           ///< block rows and columns of the matrix
  std::size_t cells = 0;             ///< per side; `columns` where those are no more than were asked for
  std::vector<std::uint32_t> count;  ///< cells x cells, row by row from the top; zero above the diagonal

  [[nodiscard]] std::uint32_t at(std::size_t row, std::size_t column) const {
    return count[row * cells + column];
  }
  /// Places for blocks in a cell, on and below the diagonal: at / possible is its density.
  [[nodiscard]] std::int64_t possible(std::size_t row, std::size_t column) const;
};

struct Sparsity {
  std::string ordering;           ///< "natural", "leaves first" or "amd" (Structure::ordering)
  std::size_t columns = 0;        ///< block columns: unknown vertices
  std::int64_t dimension = 0;     ///< scalar unknowns
  std::size_t dense_columns = 0;  ///< block columns ordered last as they touch very many edges
  TriangleCount matrix;           ///< of H
  TriangleCount factor;           ///< of L, without the zeros that solvers store for speed
  DensityRaster natural;          ///< H, vertices in the order of the graph
  DensityRaster ordered;          ///< H in the order in which block_cholesky eliminates
  DensityRaster factor_raster;    ///< L in that order

  /// Numbers of L per number of H; 1: no fill. 0 without unknowns.
  [[nodiscard]] double fill_ratio() const;
};

/// The pattern of a graph's normal equations as `optimize` makes it, vertices held for the gauge left out,
/// and of their factor. Chains are eliminated from both ends (block_symbolic.hpp), so that `ordered` need not
/// be the order of any file. Time and memory go with the blocks of L.
/// @param most_cells  of a raster, per side; >= 1
/// @throws InputError where the gauge is undetermined (find_gauge); UsageError for no cells.
[[nodiscard]] Sparsity sparsity_of(const Graph& graph, std::size_t most_cells = 200);

}  // namespace waymark::evaluation
