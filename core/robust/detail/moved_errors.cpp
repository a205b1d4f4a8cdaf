#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <utility>

#include <waymark/core/robust/detail/moved_errors.hpp>
#include <waymark/core/robust/edge_selection.hpp>

namespace waymark::detail {

double squared_error_after(const EdgeBatchBase& batch, std::size_t edge, Graph& graph,
                           std::span<const VertexIndex> moved, const FiniteMotion& motion) {
  std::vector<std::vector<double>> before;
  for (const VertexIndex v : moved) {
    before.emplace_back(graph.value(v).begin(), graph.value(v).end());
    move(graph, v, motion);
  }
  const double squared = squared_error(batch, edge, graph.view());
  for (std::size_t i = 0; i < moved.size(); ++i) graph.set_value(moved[i], before[i]);
  return squared;
}

std::vector<EdgePlace> most_that_agree(Graph graph, std::span<const EdgePlace> edges, double bound) {
  constexpr std::size_t kComparisons = 300'000;
  std::vector<EdgePlace> pairs;
  for (const EdgePlace place : edges) {
    if (graph.batch(place.batch).vertices(place.edge).size() == 2) pairs.push_back(place);
  }
  const auto later_end = [&](EdgePlace place) {
    const std::span<const VertexIndex> ends = graph.batch(place.batch).vertices(place.edge);
    return std::array{graph.id(ends[0]) < graph.id(ends[1]) ? ends[1] : ends[0]};
  };
  std::vector<EdgePlace> most;
  const std::size_t stride = 1 + pairs.size() * pairs.size() / kComparisons;
  for (std::size_t i = 0; i < pairs.size(); i += stride) {
    const EdgeBatchBase& batch = graph.batch(pairs[i].batch);
    const std::optional<FiniteMotion> motion =
        motion_to_agree(batch, pairs[i].edge, graph, later_end(pairs[i]));
    if (!motion) continue;
    const auto agrees = [&](EdgePlace place) {
      const EdgeBatchBase& other = graph.batch(place.batch);
      return squared_error_after(other, place.edge, graph, later_end(place), *motion) <= bound;
    };
    std::vector<EdgePlace> all;
    std::copy_if(pairs.begin(), pairs.end(), std::back_inserter(all), agrees);
    if (all.size() > most.size()) most = std::move(all);
  }
  return most;
}

}  // namespace waymark::detail
