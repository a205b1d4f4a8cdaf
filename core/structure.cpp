#include <algorithm>
#include <cmath>
#include <numeric>

#include <waymark/core/incidence.hpp>
#include <waymark/core/structure.hpp>

namespace waymark {
namespace {

std::size_t at(std::int64_t i) {
  return static_cast<std::size_t>(i);
}

/// Pairs of block columns (row < column) that share an edge, by column; rows sorted, each once.
struct Columns {
  std::vector<std::int64_t> begin;
  std::vector<int> rows;
};

template <typename Visit>
void for_each_pair(const Graph& graph, const std::vector<int>& column_of, Visit visit) {
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    const EdgeBatchBase& batch = graph.batch(b);
    for (std::size_t e = 0; e < batch.size(); ++e) {
      const auto vertices = batch.vertices(e);
      for (std::size_t k = 1; k < vertices.size(); ++k) {
        const int first = column_of[at(vertices[k])];
        if (first < 0) continue;
        for (std::size_t l = 0; l < k; ++l) {
          const int second = column_of[at(vertices[l])];
          if (second >= 0) visit(std::min(first, second), std::max(first, second));
        }
      }
    }
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
  std::vector<int> rows(at(count.back()));
  std::vector<std::int64_t> next(count.begin(), count.end() - 1);
  for_each_pair(graph, column_of, [&](int row, int column) {
    if (column >= first_column) rows[at(next[at(column)]++)] = row;
  });
  result.begin.assign(1, 0);
  for (int j = 0; j < columns; ++j) {
    const auto from = rows.begin() + count[at(j)];
    const auto to = rows.begin() + count[at(j) + 1];
    std::sort(from, to);
    result.rows.insert(result.rows.end(), from, std::unique(from, to));
    result.begin.push_back(static_cast<std::int64_t>(result.rows.size()));
  }
  return result;
}

/// Neighbours in both directions, from the upper triangle.
Columns symmetric(const Columns& upper, int n) {
  Columns both;
  both.begin.assign(at(n) + 1, 0);
  for (int j = 0; j < n; ++j) {
    for (auto k = upper.begin[at(j)]; k < upper.begin[at(j) + 1]; ++k) {
      ++both.begin[at(j) + 1];
      ++both.begin[at(upper.rows[at(k)]) + 1];
    }
  }
  std::partial_sum(both.begin.begin(), both.begin.end(), both.begin.begin());
  both.rows.resize(at(both.begin.back()));
  std::vector<std::int64_t> next(both.begin.begin(), both.begin.end() - 1);
  for (int j = 0; j < n; ++j) {
    for (auto k = upper.begin[at(j)]; k < upper.begin[at(j) + 1]; ++k) {
      const int i = upper.rows[at(k)];
      both.rows[at(next[at(j)]++)] = i;
      both.rows[at(next[at(i)]++)] = j;
    }
  }
  for (int j = 0; j < n; ++j) {
    std::sort(both.rows.begin() + both.begin[at(j)], both.rows.begin() + both.begin[at(j) + 1]);
  }
  return both;
}

/// A column is dense when its type says so or when it meets far more others than a pose ever does.
bool is_dense(std::int64_t degree, int n) {
  return static_cast<double>(degree) > std::max(64.0, 10.0 * std::sqrt(static_cast<double>(n)));
}

}  // namespace

void Structure::choose_unknowns(const Graph& graph, std::span<const char> held) {
  const std::vector<char> has_edge = vertices_with_edges(graph);
  for (std::size_t v = column_of_.size(); v < graph.vertex_count(); ++v) {
    const auto vertex = static_cast<VertexIndex>(v);
    const bool unknown = has_edge[v] && !graph.fixed(vertex) && held[v] == 0;
    column_of_.push_back(unknown ? static_cast<int>(vertex_of_.size()) : -1);
    if (unknown) vertex_of_.push_back(vertex);
  }
}

void Structure::build(const Graph& graph, std::span<const char> held) {
  column_of_.clear();
  vertex_of_.clear();
  choose_unknowns(graph, held);
  const int n = static_cast<int>(vertex_of_.size());

  // Split into sparse columns, which are ordered, and dense ones, which go last.
  const Columns insertion = symmetric(collect_columns(graph, column_of_, 0, n), n);
  std::vector<int> sparse;
  std::vector<int> dense;
  std::vector<int> place(at(n), -1);
  for (int j = 0; j < n; ++j) {
    const bool last = graph.vertex_type(vertex_of_[at(j)]).dense ||
                      is_dense(insertion.begin[at(j) + 1] - insertion.begin[at(j)], n);
    if (!last) place[at(j)] = static_cast<int>(sparse.size());
    (last ? dense : sparse).push_back(j);
  }
  Columns ordered;
  ordered.begin.assign(1, 0);
  for (const int j : sparse) {
    for (auto k = insertion.begin[at(j)]; k < insertion.begin[at(j) + 1]; ++k) {
      const int neighbour = place[at(insertion.rows[at(k)])];
      if (neighbour >= 0) ordered.rows.push_back(neighbour);
    }
    ordered.begin.push_back(static_cast<std::int64_t>(ordered.rows.size()));
  }
  BlockOrder order = order_blocks(ordered.begin, ordered.rows);
  ordering_ = order.method;
  dense_columns_ = static_cast<int>(dense.size());

  std::vector<VertexIndex> vertices;
  for (const int k : order.order) vertices.push_back(vertex_of_[at(sparse[at(k)])]);
  for (const int j : dense) vertices.push_back(vertex_of_[at(j)]);
  vertex_of_ = std::move(vertices);
  for (int j = 0; j < n; ++j) column_of_[at(vertex_of_[at(j)])] = j;

  make_pattern(graph, 0);
  size_scratch(graph);
  make_scatter(graph, false);
}

void Structure::extend(const Graph& graph, std::span<const char> held) {
  const int old_columns = static_cast<int>(vertex_of_.size());
  const std::size_t old_vertices = column_of_.size();
  bool append_only = dense_columns_ == 0;
  for (std::size_t v = old_vertices; v < graph.vertex_count(); ++v) {
    append_only = append_only && !graph.vertex_type(static_cast<VertexIndex>(v)).dense;  // goes last
  }
  for (std::size_t b = 0; b < graph.batch_count() && append_only; ++b) {
    const std::size_t known = b < scattered_edges_.size() ? scattered_edges_[b] : 0;
    for (std::size_t e = known; e < graph.batch(b).size() && append_only; ++e) {
      const auto vertices = graph.batch(b).vertices(e);
      // Two old vertices in one new edge may need a block inside an old column; an old vertex that had no
      // edge before needs a column of its own in the middle.
      const auto old_in_edge = std::count_if(vertices.begin(), vertices.end(),
                                             [&](VertexIndex v) { return at(v) < old_vertices; });
      const bool loose = std::any_of(vertices.begin(), vertices.end(), [&](VertexIndex v) {
        return at(v) < old_vertices && column_of_[at(v)] < 0 && !graph.fixed(v) && held[at(v)] == 0;
      });
      append_only = !loose && old_in_edge <= 1;
    }
  }
  if (append_only) {
    choose_unknowns(graph, held);
    make_pattern(graph, old_columns);
    const auto old_scratch = scratch_block_;
    size_scratch(graph);
    // Held vertices point behind the numbers, which have grown: their offsets are made again with the rest.
    make_scatter(graph, old_scratch == 0 && scratch_block_ == 0);
    return;
  }
  const std::vector<VertexIndex> old_order = vertex_of_;
  const auto first_dense = old_order.end() - dense_columns_;
  column_of_.clear();
  vertex_of_.clear();
  choose_unknowns(graph, held);
  std::vector<VertexIndex> vertices(old_order.begin(), first_dense);
  std::vector<char> placed(graph.vertex_count(), 0);
  for (const VertexIndex v : old_order) placed[at(v)] = 1;
  std::vector<VertexIndex> new_dense;
  for (const VertexIndex v : vertex_of_) {
    if (!placed[at(v)]) (graph.vertex_type(v).dense ? new_dense : vertices).push_back(v);
  }
  vertices.insert(vertices.end(), first_dense, old_order.end());
  vertices.insert(vertices.end(), new_dense.begin(), new_dense.end());
  dense_columns_ += static_cast<int>(new_dense.size());
  vertex_of_ = std::move(vertices);
  for (std::size_t j = 0; j < vertex_of_.size(); ++j) column_of_[at(vertex_of_[j])] = static_cast<int>(j);
  make_pattern(graph, 0);
  size_scratch(graph);
  make_scatter(graph, false);
}

void Structure::make_pattern(const Graph& graph, int first_column) {
  const int n = static_cast<int>(vertex_of_.size());
  const std::uint64_t version = pattern_.version + 1;
  if (first_column == 0) pattern_ = BlockPattern();
  pattern_.version = version;
  const Columns upper = collect_columns(graph, column_of_, first_column, n);
  for (int j = first_column; j < n; ++j) {
    const int size = graph.vertex_type(vertex_of_[at(j)]).tangent_size;
    pattern_.size.push_back(size);
    pattern_.start.push_back(pattern_.start.back() + size);
    int height = 0;
    const auto add_row = [&](int row) {
      pattern_.row.push_back(row);
      pattern_.row_offset.push_back(height);
      height += pattern_.size[at(row)];
    };
    for (auto k = upper.begin[at(j)]; k < upper.begin[at(j) + 1]; ++k) add_row(upper.rows[at(k)]);
    add_row(j);
    pattern_.column.push_back(static_cast<std::int64_t>(pattern_.row.size()));
    pattern_.height.push_back(height);
    pattern_.value.push_back(pattern_.value.back() + std::int64_t{height} * size);
  }
}

// Room behind the numbers for the largest block and the longest tangent that a held vertex can have.
void Structure::size_scratch(const Graph& graph) {
  std::int64_t longest = 0;
  for (std::size_t v = 0; v < graph.vertex_count(); ++v) {
    longest = std::max<std::int64_t>(longest, graph.vertex_type(static_cast<VertexIndex>(v)).tangent_size);
  }
  const bool any_held = std::any_of(column_of_.begin(), column_of_.end(), [](int c) { return c < 0; });
  scratch_row_ = any_held ? longest : 0;
  scratch_block_ = any_held ? longest * longest : 0;
}

BlockTarget Structure::target(const Graph& graph, VertexIndex k, VertexIndex l) const {
  const int first = column_of(k);
  const int second = column_of(l);
  if (first < 0 || second < 0) {
    return {pattern_.value_count(), graph.vertex_type(k).tangent_size, false};
  }
  const int row = std::min(first, second);
  const int column = std::max(first, second);
  const auto from = pattern_.row.begin() + pattern_.column[at(column)];
  const auto to = pattern_.row.begin() + pattern_.column[at(column) + 1];
  const auto entry = at(std::lower_bound(from, to, row) - pattern_.row.begin());
  // The kernel's block has the rows of k and the columns of l; stored are the rows of the earlier one.
  return {pattern_.value[at(column)] + pattern_.row_offset[entry], pattern_.height[at(column)],
          first > second};
}

void Structure::make_scatter(const Graph& graph, bool only_new) {
  scatters_.resize(graph.batch_count());
  scattered_edges_.resize(graph.batch_count(), 0);
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    const EdgeBatchBase& batch = graph.batch(b);
    Scatter& scatter = scatters_[b];
    if (!only_new) {
      scatter = Scatter();
      scattered_edges_[b] = 0;
    }
    for (std::size_t e = scattered_edges_[b]; e < batch.size(); ++e) {
      const auto vertices = batch.vertices(e);
      for (std::size_t k = 0; k < vertices.size(); ++k) {
        const int column = column_of(vertices[k]);
        scatter.gradient.push_back(column < 0 ? pattern_.dimension() : pattern_.start[at(column)]);
        for (std::size_t l = 0; l <= k; ++l)
          scatter.blocks.push_back(target(graph, vertices[k], vertices[l]));
      }
    }
    scattered_edges_[b] = batch.size();
  }
}

}  // namespace waymark
