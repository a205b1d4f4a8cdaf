#include <algorithm>
#include <utility>

#include <waymark/core/base/detail/index.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/core/system/structure.hpp>

namespace waymark {
namespace {

using detail::at;

/// A block above the diagonal. Blocks are sorted by column, then row.
struct Block {
  int column = 0;
  int row = 0;
  friend auto operator<=>(const Block&, const Block&) = default;
};

/// Returns the blocks that edges from `first_edge` on (per batch) need, each once.
std::vector<Block> blocks_of_new_edges(const Graph& graph, const std::vector<int>& column_of,
                                       std::span<const std::size_t> first_edge) {
  std::vector<Block> blocks;
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    const auto look = [&](std::span<const VertexIndex> vertices) {
      for (std::size_t k = 1; k < vertices.size(); ++k) {
        const int first = column_of[at(vertices[k])];
        for (std::size_t l = 0; l < k && first >= 0; ++l) {
          const int second = column_of[at(vertices[l])];
          if (second >= 0) blocks.push_back({std::max(first, second), std::min(first, second)});
        }
      }
    };
    for_each_edge(graph.batch(b), look, b < first_edge.size() ? first_edge[b] : 0);
  }
  std::sort(blocks.begin(), blocks.end());
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  return blocks;
}

/// The blocks above the diagonal, by column.
struct FollowedColumns {
  std::vector<std::int64_t> begin{0};
  std::vector<int> rows;     // ascending in a column
  std::vector<char> intact;  // per column: its rows have not changed
};

/// Returns the remaining part of a pattern with the added blocks.
/// @param old_column of each new one; -1: there is none
/// @param new_column of each old one; -1: there is none
FollowedColumns follow_columns(const BlockPattern& pattern, std::span<const int> new_column,
                               std::span<const int> old_column, std::span<const Block> added) {
  FollowedColumns result;
  std::vector<int>& rows = result.rows;
  rows.reserve(pattern.row.size() + added.size());
  auto next = added.begin();
  for (std::size_t j = 0; j < old_column.size(); ++j) {
    const auto first = static_cast<std::ptrdiff_t>(rows.size());
    std::int64_t had = -1;
    if (const int old = old_column[j]; old >= 0) {
      const std::int64_t diagonal = pattern.column[at(old) + 1] - 1;
      had = diagonal - pattern.column[at(old)];
      for (auto k = pattern.column[at(old)]; k < diagonal; ++k) {
        const int row = new_column[at(pattern.row[at(k)])];
        if (row >= 0) rows.push_back(row);  // ascending, because the order stays
      }
    }
    const auto kept = static_cast<std::ptrdiff_t>(rows.size());
    for (; next != added.end() && next->column == static_cast<int>(j); ++next) rows.push_back(next->row);
    std::inplace_merge(rows.begin() + first, rows.begin() + kept, rows.end());
    rows.erase(std::unique(rows.begin() + first, rows.end()), rows.end());
    result.intact.push_back(kept - first == had && static_cast<std::ptrdiff_t>(rows.size()) == kept);
    result.begin.push_back(static_cast<std::int64_t>(rows.size()));
  }
  return result;
}

}  // namespace

void Structure::remove(const Graph& graph, const Removal& removal, std::span<const char> held) {
  if (removal.new_index.size() != column_of_.size()) {
    throw UsageError("Structure::remove: the structure had not followed the graph; call extend() first");
  }
  std::vector<VertexIndex> old_order;
  old_order.reserve(vertex_of_.size());
  for (const VertexIndex v : vertex_of_) old_order.push_back(removal.new_index[at(v)]);
  column_of_.clear();
  vertex_of_.clear();
  choose_unknowns(graph, held);
  keep_order(graph, old_order);

  std::vector<int> old_column(vertex_of_.size(), -1);  // of each new one; -1: there is none
  std::vector<int> new_column(old_order.size(), -1);   // of each old one; -1: it was removed
  for (std::size_t j = 0; j < old_order.size(); ++j) {
    if (old_order[j] < 0 || column_of_[at(old_order[j])] < 0) continue;
    new_column[j] = column_of_[at(old_order[j])];
    old_column[at(new_column[j])] = static_cast<int>(j);
  }
  const std::vector<Block> added = blocks_of_new_edges(graph, column_of_, removal.kept_edges);
  const FollowedColumns upper = follow_columns(pattern_, new_column, old_column, added);
  const std::vector<std::int64_t> old_value = pattern_.value;
  make_pattern(graph, 0, upper.begin, upper.rows);
  size_slots(graph);
  std::vector<std::optional<std::int64_t>> shifts(vertex_of_.size());
  for (std::size_t j = 0; j < shifts.size() - at(dense_columns_); ++j) {
    if (upper.intact[j] != 0) shifts[j] = pattern_.value[j] - old_value[at(old_column[j])];
  }
  move_scatter(graph, removal, shifts);
  collect_held_coordinates(graph, held);
}

// Blocks of remaining edges move with their columns. Blocks at a held vertex, a dense column or a
// column with lost or added rows are looked up again.
void Structure::move_scatter(const Graph& graph, const Removal& removal,
                             std::span<const std::optional<std::int64_t>> shifts) {
  scatters_.resize(graph.batch_count());
  scattered_edges_.resize(graph.batch_count(), 0);
  std::vector<std::vector<EdgeRange>> ranges;
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    const EdgeBatchBase& batch = graph.batch(b);
    const Scatter before = std::exchange(scatters_[b], {});
    Scatter& scatter = scatters_[b];
    scatter.gradient.reserve(before.gradient.size());
    scatter.blocks.reserve(before.blocks.size());
    // 0: the earlier places of the blocks of an edge are not known
    const auto arity = at(batch.vertex_table().arity);
    const std::size_t known = arity > 0 && b < removal.kept_edges.size() ? removal.kept_edges[b] : 0;
    ranges.assign(at(chunks_), {});
    std::uint32_t edge = 0;
    std::size_t old_edge = 0;
    for_each_edge(batch, [&](std::span<const VertexIndex> vertices) {
      const bool stayed = edge < known;
      while (stayed && removal.gone_edges[b][old_edge] != 0) ++old_edge;
      std::size_t old_block = old_edge * (arity * (arity + 1) / 2);
      const int chunk = chunk_of(vertices);
      add_to_ranges(edge++, ranges[at(chunk)]);
      ++old_edge;
      for (std::size_t k = 0; k < vertices.size(); ++k) {
        const int first = column_of(vertices[k]);
        scatter.gradient.push_back(static_cast<std::uint32_t>(gradient_target(chunk, first)));
        for (std::size_t l = 0; l <= k; ++l, ++old_block) {
          const int second = column_of(vertices[l]);
          if (stayed && std::min(first, second) >= 0 && shifts[at(std::max(first, second))]) {
            const BlockTarget& old = before.blocks[old_block];
            const std::int64_t offset = old.offset + *shifts[at(std::max(first, second))];
            scatter.blocks.push_back({static_cast<std::uint32_t>(offset), old.stride});
          } else {
            scatter.blocks.push_back(target(chunk, first, second));
          }
        }
      }
    });
    scattered_edges_[b] = batch.size();
    set_ranges(ranges, scatter);
  }
}

// Edges at a held vertex point to slots.
void Structure::retarget_held(const Graph& graph) {
  for (std::size_t b = 0; b < scattered_edges_.size() && slot_block_ > 0; ++b) {
    std::size_t edge = 0;
    std::uint32_t* row = scatters_[b].gradient.data();
    BlockTarget* block = scatters_[b].blocks.data();
    for_each_edge(graph.batch(b), [&](std::span<const VertexIndex> vertices) {
      if (edge++ >= scattered_edges_[b]) return;
      const std::size_t arity = vertices.size();
      if (std::any_of(vertices.begin(), vertices.end(), [&](VertexIndex v) { return column_of(v) < 0; })) {
        const int chunk = chunk_of(vertices);
        for (std::size_t k = 0; k < arity; ++k) {
          const int column = column_of(vertices[k]);
          row[k] = static_cast<std::uint32_t>(gradient_target(chunk, column));
          for (std::size_t l = 0; l <= k; ++l)
            block[k * (k + 1) / 2 + l] = target(chunk, column, column_of(vertices[l]));
        }
      }
      row += arity;
      block += arity * (arity + 1) / 2;
    });
  }
}

}  // namespace waymark
