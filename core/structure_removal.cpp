#include <algorithm>

#include <waymark/core/error.hpp>
#include <waymark/core/structure.hpp>

namespace waymark {
namespace {

std::size_t at(std::int64_t i) {
  return static_cast<std::size_t>(i);
}

/// A block above the diagonal; sorted by column, then row.
struct Block {
  int column = 0;
  int row = 0;
  friend auto operator<=>(const Block&, const Block&) = default;
};

/// The blocks that edges from `first_edge` on (per batch) need, each once.
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

  std::vector<int> old_column(vertex_of_.size(), -1);  // of each new one; -1: it had none
  std::vector<int> new_column(old_order.size(), -1);   // of each old one; -1: it is gone
  for (std::size_t j = 0; j < old_order.size(); ++j) {
    if (old_order[j] < 0 || column_of_[at(old_order[j])] < 0) continue;
    new_column[j] = column_of_[at(old_order[j])];
    old_column[at(new_column[j])] = static_cast<int>(j);
  }
  const std::vector<Block> added = blocks_of_new_edges(graph, column_of_, removal.kept_edges);
  std::vector<std::int64_t> begin{0};
  std::vector<int> rows;
  rows.reserve(pattern_.row.size() + added.size());
  auto next = added.begin();
  for (std::size_t j = 0; j < vertex_of_.size(); ++j) {
    const auto first = static_cast<std::ptrdiff_t>(rows.size());
    if (const int old = old_column[j]; old >= 0) {
      for (auto k = pattern_.column[at(old)]; k < pattern_.column[at(old) + 1] - 1; ++k) {
        const int row = new_column[at(pattern_.row[at(k)])];
        if (row >= 0) rows.push_back(row);  // ascending, as the order stays
      }
    }
    const auto kept = static_cast<std::ptrdiff_t>(rows.size());
    for (; next != added.end() && next->column == static_cast<int>(j); ++next) rows.push_back(next->row);
    if (static_cast<std::ptrdiff_t>(rows.size()) > kept) {
      std::inplace_merge(rows.begin() + first, rows.begin() + kept, rows.end());
      rows.erase(std::unique(rows.begin() + first, rows.end()), rows.end());
    }
    begin.push_back(static_cast<std::int64_t>(rows.size()));
  }
  make_pattern(graph, 0, begin, rows);
  size_slots(graph);
  make_scatter(graph, false);
}

}  // namespace waymark
