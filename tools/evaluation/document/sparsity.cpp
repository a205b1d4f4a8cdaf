#include <waymark/tools/evaluation/document/sparsity.hpp>

#include <algorithm>
#include <numeric>

#include <waymark/core/base/error.hpp>
#include <waymark/core/linear/block_symbolic.hpp>
#include <waymark/core/system/gauge.hpp>
#include <waymark/core/system/structure.hpp>

namespace waymark::evaluation {
namespace {

std::size_t at(std::int64_t i) {
  return static_cast<std::size_t>(i);
}

DensityRaster empty_raster(std::size_t columns, std::size_t most_cells) {
  DensityRaster raster;
  raster.columns = columns;
  raster.cells = std::min(columns, most_cells);
  raster.count.assign(raster.cells * raster.cells, 0);
  return raster;
}

/// Counts blocks and enters them into a raster.
class Counter {
 public:
  Counter(DensityRaster& raster, TriangleCount& count) : raster_(raster), count_(count) {}

  /// Row and column are indices in the order of the raster.
  void add(int row, int column, int row_size, int column_size) {
    const auto low = at(std::min(row, column));
    const auto high = at(std::max(row, column));
    ++raster_.count[cell(high) * raster_.cells + cell(low)];
    ++count_.blocks;
    const std::int64_t numbers = std::int64_t{row_size} * column_size;
    count_.scalars += row == column ? (numbers + row_size) / 2 : numbers;
  }

 private:
  [[nodiscard]] std::size_t cell(std::size_t place) const { return place * raster_.cells / raster_.columns; }

  DensityRaster& raster_;
  TriangleCount& count_;
};

/// Calls visit(row, column) for every stored block of H, by columns of the pattern, row <= column.
template <typename Visit>
void for_each_block(const BlockPattern& pattern, Visit visit) {
  for (int j = 0; j < pattern.columns(); ++j) {
    for (auto e = pattern.column[at(j)]; e < pattern.column[at(j) + 1]; ++e) visit(pattern.row[at(e)], j);
  }
}

/// The blocks of H left of the diagonal, by rows of another order.
struct LowerRows {
  std::vector<std::int64_t> begin;
  std::vector<int> column;
};

LowerRows lower_rows(const BlockPattern& pattern, const std::vector<int>& place) {
  LowerRows rows;
  rows.begin.assign(place.size() + 1, 0);
  const auto visit = [&](auto take) {
    for_each_block(pattern, [&](int i, int j) {
      if (i != j) take(std::max(place[at(i)], place[at(j)]), std::min(place[at(i)], place[at(j)]));
    });
  };
  visit([&](int row, int) { ++rows.begin[at(row) + 1]; });
  std::partial_sum(rows.begin.begin(), rows.begin.end(), rows.begin.begin());
  rows.column.resize(at(rows.begin.back()));
  std::vector<std::int64_t> next(rows.begin.begin(), rows.begin.end() - 1);
  visit([&](int row, int column) { rows.column[at(next[at(row)]++)] = column; });
  return rows;
}

/// Calls visit(row, column) for every block of the factor. Row k is the union of the paths in
/// the elimination tree from its entries towards k (Gilbert, Ng, Peyton 1994). The tree grows
/// during the walk.
template <typename Visit>
void for_each_factor_block(const LowerRows& lower, Visit visit) {
  const std::size_t n = lower.begin.size() - 1;
  std::vector<int> parent(n, -1);
  std::vector<int> seen(n, -1);
  for (std::size_t k = 0; k < n; ++k) {
    const int row = static_cast<int>(k);
    seen[k] = row;
    visit(row, row);
    for (auto e = lower.begin[k]; e < lower.begin[k + 1]; ++e) {
      for (int j = lower.column[at(e)]; seen[at(j)] != row; j = parent[at(j)]) {
        if (parent[at(j)] < 0) parent[at(j)] = row;
        seen[at(j)] = row;
        visit(row, j);
      }
    }
  }
}

/// Returns the places of the pattern's columns in the order of the graph's vertices.
std::vector<int> natural_places(const Graph& graph, const Structure& structure) {
  std::vector<int> place(at(structure.pattern().columns()));
  int next = 0;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    if (const int column = structure.column_of(v); column >= 0) place[at(column)] = next++;
  }
  return place;
}

std::vector<int> elimination_places(const BlockSymbolic& symbolic) {
  std::vector<int> place(symbolic.column.size());
  for (std::size_t k = 0; k < place.size(); ++k) place[at(symbolic.column[k])] = static_cast<int>(k);
  return place;
}

}  // namespace

std::int64_t DensityRaster::possible(std::size_t row, std::size_t column) const {
  if (column > row) return 0;
  const auto extent = [&](std::size_t cell) {
    const auto first = [&](std::size_t c) { return (c * columns + cells - 1) / cells; };
    return static_cast<std::int64_t>(first(cell + 1) - first(cell));
  };
  return row == column ? extent(row) * (extent(row) + 1) / 2 : extent(row) * extent(column);
}

double Sparsity::fill_ratio() const {
  if (matrix.scalars == 0) return 0;
  return static_cast<double>(factor.scalars) / static_cast<double>(matrix.scalars);
}

Sparsity sparsity_of(const Graph& graph, std::size_t most_cells) {
  if (most_cells == 0) throw UsageError("sparsity: a raster needs at least one cell");
  Structure structure;
  structure.build(graph, find_gauge(graph).held);
  const BlockPattern& pattern = structure.pattern();
  Sparsity result;
  result.ordering = structure.ordering();
  result.columns = at(pattern.columns());
  result.dimension = pattern.dimension();
  result.dense_columns = at(structure.dense_columns());
  result.natural = result.ordered = result.factor_raster = empty_raster(result.columns, most_cells);
  if (result.columns == 0) return result;

  const BlockSymbolic symbolic = analyze_blocks(pattern);
  const std::vector<int> natural = natural_places(graph, structure);
  const std::vector<int> place = elimination_places(symbolic);
  TriangleCount same;  // of H in another order
  Counter in_natural(result.natural, same);
  Counter in_order(result.ordered, result.matrix);
  for_each_block(pattern, [&](int i, int j) {
    const int rows = pattern.size[at(i)];
    const int columns = pattern.size[at(j)];
    in_natural.add(natural[at(i)], natural[at(j)], rows, columns);
    in_order.add(place[at(i)], place[at(j)], rows, columns);
  });
  Counter in_factor(result.factor_raster, result.factor);
  for_each_factor_block(lower_rows(pattern, place), [&](int row, int column) {
    in_factor.add(row, column, symbolic.size[at(row)], symbolic.size[at(column)]);
  });
  return result;
}

}  // namespace waymark::evaluation
