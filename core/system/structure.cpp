#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include <waymark/core/base/detail/index.hpp>
#include <waymark/core/linear/detail/factor_work.hpp>
#include <waymark/core/system/detail/incidence.hpp>
#include <waymark/core/system/detail/time_order.hpp>
#include <waymark/core/system/held_marks.hpp>
#include <waymark/core/system/structure.hpp>

namespace waymark {
namespace {

using detail::at;

/// Pairs of block columns (row < column) that share an edge, by column. Rows are sorted and unique.
struct Columns {
  std::vector<std::int64_t> begin;
  std::vector<int> rows;
};

template <typename Visit>
void for_each_pair(const Graph& graph, const std::vector<int>& column_of, Visit visit) {
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    for_each_edge(graph.batch(b), [&](std::span<const VertexIndex> vertices) {
      for (std::size_t k = 1; k < vertices.size(); ++k) {
        const int first = column_of[at(vertices[k])];
        if (first < 0) continue;
        for (std::size_t l = 0; l < k; ++l) {
          const int second = column_of[at(vertices[l])];
          if (second >= 0) visit(std::min(first, second), std::max(first, second));
        }
      }
    });
  }
}

Columns collect_columns(const Graph& graph, const std::vector<int>& column_of, int first_column,
                        int columns) {
  Columns result;
  std::vector<std::int64_t> count(at(columns) + 1, 0);
  for_each_pair(graph, column_of, [&](int, int column) {
    if (column >= first_column) ++count[at(column) + 1];
  });
  std::partial_sum(count.begin(), count.end(), count.begin());
  std::vector<int>& rows = result.rows;
  rows.resize(at(count.back()));
  std::vector<std::int64_t> next(count.begin(), count.end() - 1);
  for_each_pair(graph, column_of, [&](int row, int column) {
    if (column >= first_column) rows[at(next[at(column)]++)] = row;
  });
  // Sort the rows, make them unique, and close the gaps.
  result.begin.assign(at(columns) + 1, 0);
  std::int64_t kept = 0;
  for (int j = 0; j < columns; ++j) {
    const auto from = rows.begin() + count[at(j)];
    const auto to = rows.begin() + count[at(j) + 1];
    if (to - from > 1) std::sort(from, to);
    int before = -1;
    for (auto row = from; row != to; ++row) {
      if (*row != before) rows[at(kept++)] = before = *row;
    }
    result.begin[at(j) + 1] = kept;
  }
  rows.resize(at(kept));
  return result;
}

/// A column is dense if its type says so, or if it meets far more others than a pose ever does.
bool is_dense(std::int64_t degree, int n) {
  return static_cast<double>(degree) > std::max(64.0, 10.0 * std::sqrt(static_cast<double>(n)));
}

}  // namespace

void Structure::choose_unknowns(const Graph& graph, std::span<const char> held) {
  const std::vector<char> has_edge = vertices_with_edges(graph);
  for (std::size_t v = column_of_.size(); v < graph.vertex_count(); ++v) {
    const auto vertex = static_cast<VertexIndex>(v);
    const bool unknown = has_edge[v] && !graph.fixed(vertex) && !is_wholly_held(held[v]);
    column_of_.push_back(unknown ? static_cast<int>(vertex_of_.size()) : -1);
    if (unknown) vertex_of_.push_back(vertex);
  }
}

void Structure::collect_held_coordinates(const Graph& graph, std::span<const char> held) {
  held_coordinates_.clear();
  for (std::size_t column = 0; column < vertex_of_.size(); ++column) {
    const VertexIndex v = vertex_of_[column];
    if (held[at(v)] == 0) continue;
    for (int k = 0; k < graph.vertex_type(v).tangent_size && k < kMarkedCoordinates; ++k)
      if (holds_coordinate(held[at(v)], k)) held_coordinates_.push_back({static_cast<int>(column), k});
  }
}

bool Structure::comes_last(const Graph& graph, VertexIndex v) const {
  const VertexType& type = graph.vertex_type(v);
  return type.dense || (growing_ && type.position == nullptr);
}

void Structure::build(const Graph& graph, std::span<const char> held, bool growing) {
  growing_ = growing;
  column_of_.clear();
  vertex_of_.clear();
  choose_unknowns(graph, held);
  const int n = static_cast<int>(vertex_of_.size());
  Columns upper = collect_columns(graph, column_of_, 0, n);

  // Dense columns come last; the others are ordered.
  std::vector<int> degree(at(n), 0);
  for (int j = 0; j < n; ++j) {
    for (auto k = upper.begin[at(j)]; k < upper.begin[at(j) + 1]; ++k) {
      ++degree[at(j)];
      ++degree[at(upper.rows[at(k)])];
    }
  }
  std::vector<char> dense(at(n), 0);
  dense_columns_ = 0;
  for (int j = 0; j < n; ++j) {
    dense[at(j)] = comes_last(graph, vertex_of_[at(j)]) || is_dense(degree[at(j)], n);
    dense_columns_ += dense[at(j)];
  }
  BlockOrder order = order_blocks(upper.begin, upper.rows, dense);
  if (order.method == "amd") prefer_time_order(graph, upper.begin, upper.rows, dense, order);
  ordering_ = order.method;
  const bool kept = std::is_sorted(order.order.begin(), order.order.end());
  if (!kept) {
    std::vector<VertexIndex> vertices;
    vertices.reserve(at(n));
    for (const int k : order.order) vertices.push_back(vertex_of_[at(k)]);
    vertex_of_ = std::move(vertices);
    for (int j = 0; j < n; ++j) column_of_[at(vertex_of_[at(j)])] = j;
    upper = collect_columns(graph, column_of_, 0, n);
  }
  make_pattern(graph, 0, upper.begin, upper.rows);
  size_slots(graph);
  make_scatter(graph, false);
  collect_held_coordinates(graph, held);
}

// The states of a drive that begin and end, such as the biases of satellites, make a narrow band in the order of
// time. Minimum degree does not find it, and may need sixty times the work.
void Structure::prefer_time_order(const Graph& graph, std::span<const std::int64_t> begin,
                                  std::span<const int> rows, std::span<const char> dense,
                                  BlockOrder& order) const {
  const auto has_stamp = [&](VertexIndex v) { return graph.stamp(v).has_value(); };
  if (std::none_of(vertex_of_.begin(), vertex_of_.end(), has_stamp)) return;
  std::vector<int> timed;
  timed.reserve(vertex_of_.size());
  for (const VertexIndex v : detail::time_order(graph)) {
    const int column = column_of_[at(v)];
    if (column >= 0 && !dense[at(column)]) timed.push_back(column);
  }
  for (std::size_t j = 0; j < dense.size(); ++j) {
    if (dense[j]) timed.push_back(static_cast<int>(j));
  }
  std::vector<int> sizes;
  sizes.reserve(vertex_of_.size());
  for (const VertexIndex v : vertex_of_) sizes.push_back(graph.vertex_type(v).tangent_size);
  const double unlimited = std::numeric_limits<double>::max();
  const double work = detail::factor_work(begin, rows, order.order, sizes, unlimited);
  if (detail::factor_work(begin, rows, timed, sizes, work) < work) order = {std::move(timed), "time"};
}

void Structure::extend(const Graph& graph, std::span<const char> held) {
  const int old_columns = static_cast<int>(vertex_of_.size());
  const std::size_t old_vertices = column_of_.size();
  bool append_only = dense_columns_ == 0;
  for (std::size_t v = old_vertices; v < graph.vertex_count(); ++v) {
    // a dense column comes last
    append_only = append_only && !comes_last(graph, static_cast<VertexIndex>(v));
  }
  for (std::size_t b = 0; b < graph.batch_count() && append_only; ++b) {
    const std::size_t known = b < scattered_edges_.size() ? scattered_edges_[b] : 0;
    const auto look = [&](std::span<const VertexIndex> vertices) {
      // A new edge between two old vertices may need a block inside an old column. An old vertex
      // that had no edge before needs its own column in the middle.
      const auto old_in_edge = std::count_if(vertices.begin(), vertices.end(),
                                             [&](VertexIndex v) { return at(v) < old_vertices; });
      const bool loose = std::any_of(vertices.begin(), vertices.end(), [&](VertexIndex v) {
        return at(v) < old_vertices && column_of_[at(v)] < 0 && !graph.fixed(v) &&
               !is_wholly_held(held[at(v)]);
      });
      append_only = append_only && !loose && old_in_edge <= 1;
    };
    for_each_edge(graph.batch(b), look, known);
  }
  if (append_only) {
    choose_unknowns(graph, held);
    const Columns upper =
        collect_columns(graph, column_of_, old_columns, static_cast<int>(vertex_of_.size()));
    make_pattern(graph, old_columns, upper.begin, upper.rows);
    size_slots(graph);
    retarget_held(graph);  // slots are after the numbers, which have grown
    make_scatter(graph, true);
    collect_held_coordinates(graph, held);
    return;
  }
  const std::vector<VertexIndex> old_order = vertex_of_;
  column_of_.clear();
  vertex_of_.clear();
  choose_unknowns(graph, held);
  keep_order(graph, old_order);
  const Columns upper = collect_columns(graph, column_of_, 0, static_cast<int>(vertex_of_.size()));
  make_pattern(graph, 0, upper.begin, upper.rows);
  size_slots(graph);
  make_scatter(graph, false);
  collect_held_coordinates(graph, held);
}

// Orders the chosen unknowns: old ones as they were, then new ones, then dense ones, new
// dense ones last.
void Structure::keep_order(const Graph& graph, std::span<const VertexIndex> old_order) {
  const std::size_t first_dense = old_order.size() - at(dense_columns_);
  std::vector<VertexIndex> vertices;
  std::vector<VertexIndex> dense;
  std::vector<char> placed(graph.vertex_count(), 0);
  for (std::size_t j = 0; j < old_order.size(); ++j) {
    const VertexIndex v = old_order[j];
    if (v < 0 || column_of_[at(v)] < 0) continue;
    (j < first_dense ? vertices : dense).push_back(v);
    placed[at(v)] = 1;
  }
  for (const VertexIndex v : vertex_of_) {
    if (!placed[at(v)]) (comes_last(graph, v) ? dense : vertices).push_back(v);
  }
  dense_columns_ = static_cast<int>(dense.size());
  vertices.insert(vertices.end(), dense.begin(), dense.end());
  vertex_of_ = std::move(vertices);
  for (std::size_t j = 0; j < vertex_of_.size(); ++j) column_of_[at(vertex_of_[j])] = static_cast<int>(j);
}

void Structure::make_pattern(const Graph& graph, int first_column, std::span<const std::int64_t> begin,
                             std::span<const int> rows) {
  const auto n = vertex_of_.size();
  const std::uint64_t version = pattern_.version + 1;
  if (first_column == 0) pattern_ = BlockPattern();
  BlockPattern& p = pattern_;
  p.version = version;
  p.size.reserve(n);
  p.start.reserve(n + 1);
  p.column.reserve(n + 1);
  p.height.reserve(n);
  p.value.reserve(n + 1);
  p.row.reserve(p.row.size() + rows.size() + n);
  p.row_offset.reserve(p.row.size() + rows.size() + n);
  for (auto j = at(first_column); j < n; ++j) {
    const int size = graph.vertex_type(vertex_of_[j]).tangent_size;
    p.size.push_back(size);
    p.start.push_back(p.start.back() + size);
    int height = 0;
    const auto add_row = [&](int row) {
      p.row.push_back(row);
      p.row_offset.push_back(height);
      height += p.size[at(row)];
    };
    for (auto k = begin[j]; k < begin[j + 1]; ++k) add_row(rows[at(k)]);
    add_row(static_cast<int>(j));
    p.column.push_back(static_cast<std::int64_t>(p.row.size()));
    p.height.push_back(height);
    p.value.push_back(p.value.back() + std::int64_t{height} * size);
  }
}

// Each chunk has a slot after the numbers. Its first part is scratch space for held vertices,
// as large as the largest block that an edge makes of a held vertex and any other. Its second
// part is for the blocks among dense columns: all chunks add to these blocks, so the slots are
// summed afterwards.
void Structure::size_slots(const Graph& graph) {
  int longest = 0;
  bool any_held = false;
  for (std::size_t v = 0; v < column_of_.size(); ++v) {
    any_held = any_held || column_of_[v] < 0;
    longest = std::max(longest, graph.vertex_type(static_cast<VertexIndex>(v)).tangent_size);
  }
  scratch_ = any_held ? longest : 0;
  chunks_ = static_cast<int>((graph.vertex_count() + kChunkVertices - 1) / kChunkVertices) + 1;
  dense_size_ =
      static_cast<int>(pattern_.dimension() - pattern_.start[pattern_.size.size() - at(dense_columns_)]);
  slot_block_ = std::int64_t{scratch_} * scratch_ + std::int64_t{dense_size_} * dense_size_;
  slot_row_ = scratch_ + dense_size_;
  if (hessian_size() > std::numeric_limits<std::uint32_t>::max()) {
    throw std::length_error("the normal equations have more than 2^32 numbers");
  }
}

std::int64_t Structure::gradient_target(int chunk, int column) const {
  if (column < 0) return pattern_.dimension() + chunk * slot_row_;
  const std::int64_t dense_start = pattern_.dimension() - dense_size_;
  const std::int64_t start = pattern_.start[at(column)];
  if (start < dense_start) return start;
  return pattern_.dimension() + chunk * slot_row_ + scratch_ + (start - dense_start);
}

BlockTarget Structure::target(int chunk, int first, int second) const {
  const std::int64_t slot = pattern_.value_count() + chunk * slot_block_;
  if (first < 0 || second < 0) return {static_cast<std::uint32_t>(slot), scratch_};
  const auto row = at(std::min(first, second));
  const auto column = at(std::max(first, second));
  const std::int64_t dense_start = pattern_.dimension() - dense_size_;
  std::int64_t offset;
  int stride;
  if (pattern_.start[row] >= dense_start) {
    offset = slot + std::int64_t{scratch_} * scratch_ + (pattern_.start[row] - dense_start) +
             (pattern_.start[column] - dense_start) * dense_size_;
    stride = dense_size_;
  } else {
    const auto end = at(pattern_.column[column + 1]) - 1;  // the diagonal block
    auto entry = end;
    if (row != column) {
      entry = end - 1;
      if (pattern_.row[entry] != static_cast<int>(row)) {
        const auto from = pattern_.row.begin() + pattern_.column[column];
        entry = at(std::lower_bound(from, pattern_.row.begin() + static_cast<std::ptrdiff_t>(end),
                                    static_cast<int>(row)) -
                   pattern_.row.begin());
      }
    }
    offset = pattern_.value[column] + pattern_.row_offset[entry];
    stride = pattern_.height[column];
  }
  // The block of the kernel has the rows of the first vertex and the columns of the second one. The
  // stored block has the rows of the earlier one.
  return {static_cast<std::uint32_t>(offset), first > second ? -stride : stride};
}

// Returns the chunk of an edge. If not all its vertices that are neither held nor dense are in one
// chunk, it belongs to the last chunk.
int Structure::chunk_of(std::span<const VertexIndex> vertices) const {
  const int first_dense = pattern_.columns() - dense_columns_;
  int chunk = -1;
  for (const VertexIndex v : vertices) {
    const int column = column_of(v);
    if (column < 0 || column >= first_dense) continue;
    const int own = static_cast<int>(at(v) / kChunkVertices);
    if (chunk >= 0 && own != chunk) return chunks_ - 1;
    chunk = own;
  }
  return chunk < 0 ? chunks_ - 1 : chunk;
}

void Structure::make_scatter(const Graph& graph, bool only_new) {
  scatters_.resize(graph.batch_count());
  scattered_edges_.resize(graph.batch_count(), 0);
  std::vector<std::vector<EdgeRange>> ranges;
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    const EdgeBatchBase& batch = graph.batch(b);
    Scatter& scatter = scatters_[b];
    if (!only_new) {
      scatter = Scatter();
      scattered_edges_[b] = 0;
      const auto arity = at(batch.vertex_table().arity);
      scatter.gradient.reserve(batch.size() * arity);
      scatter.blocks.reserve(batch.size() * (arity * (arity + 1) / 2));
    }
    ranges.assign(at(chunks_), {});
    for (std::size_t c = 0; c + 1 < scatter.chunk.size(); ++c) {
      // The last chunk stays the last if there are more.
      auto& list = ranges[c + 2 < scatter.chunk.size() ? c : ranges.size() - 1];
      list.assign(scatter.ranges.begin() + static_cast<std::ptrdiff_t>(scatter.chunk[c]),
                  scatter.ranges.begin() + static_cast<std::ptrdiff_t>(scatter.chunk[c + 1]));
    }
    auto edge = static_cast<std::uint32_t>(scattered_edges_[b]);
    for_each_edge(
        batch,
        [&](std::span<const VertexIndex> vertices) {
          const int chunk = chunk_of(vertices);
          add_to_ranges(edge++, ranges[at(chunk)]);
          for (std::size_t k = 0; k < vertices.size(); ++k) {
            const int column = column_of(vertices[k]);
            scatter.gradient.push_back(static_cast<std::uint32_t>(gradient_target(chunk, column)));
            for (std::size_t l = 0; l <= k; ++l) {
              scatter.blocks.push_back(target(chunk, column, column_of(vertices[l])));
            }
          }
        },
        scattered_edges_[b]);
    scattered_edges_[b] = batch.size();
    set_ranges(ranges, scatter);
  }
}

void Structure::add_to_ranges(std::uint32_t edge, std::vector<EdgeRange>& ranges) {
  if (!ranges.empty() && ranges.back().last == edge) {
    ++ranges.back().last;
  } else {
    ranges.push_back({edge, edge + 1});
  }
}

void Structure::set_ranges(std::span<const std::vector<EdgeRange>> of_chunks, Scatter& scatter) {
  scatter.ranges.clear();
  scatter.chunk.assign(1, 0);
  for (const auto& ranges : of_chunks) {
    scatter.ranges.insert(scatter.ranges.end(), ranges.begin(), ranges.end());
    scatter.chunk.push_back(scatter.ranges.size());
  }
}

bool Structure::follows(const Graph& graph) const {
  if (column_of_.size() != graph.vertex_count() || scattered_edges_.size() != graph.batch_count())
    return false;
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    if (scattered_edges_[b] != graph.batch(b).size()) return false;
  }
  return true;
}

void Structure::add_slots(double* hessian, double* gradient) const {
  if (dense_size_ == 0) return;
  const std::int64_t dense_start = pattern_.dimension() - dense_size_;
  for (int chunk = 0; chunk < chunks_; ++chunk) {
    const double* rows = gradient + pattern_.dimension() + chunk * slot_row_ + scratch_;
    for (int r = 0; r < dense_size_; ++r) gradient[dense_start + r] += rows[r];
    const double* block =
        hessian + pattern_.value_count() + chunk * slot_block_ + std::int64_t{scratch_} * scratch_;
    for (int j = pattern_.columns() - dense_columns_; j < pattern_.columns(); ++j) {
      for (auto e = pattern_.column[at(j)]; e < pattern_.column[at(j) + 1]; ++e) {
        const auto i = at(pattern_.row[at(e)]);
        if (pattern_.start[i] < dense_start) continue;
        for (int c = 0; c < pattern_.size[at(j)]; ++c) {
          double* to = hessian + pattern_.value[at(j)] + pattern_.row_offset[at(e)] +
                       std::int64_t{c} * pattern_.height[at(j)];
          const double* from = block + (pattern_.start[i] - dense_start) +
                               (pattern_.start[at(j)] - dense_start + c) * dense_size_;
          for (int r = 0; r < pattern_.size[i]; ++r) to[r] += from[r];
        }
      }
    }
  }
}

}  // namespace waymark
