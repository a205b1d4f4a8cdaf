#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <waymark/core/robust/chi_square.hpp>
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

namespace {

double area_of_poses(const Graph& graph) {
  Eigen::AlignedBox2d box;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    const auto position = graph.vertex_type(v).position;
    if (position != nullptr) box.extend(position(graph.value(v).data()));
  }
  return box.isEmpty() ? 0 : box.sizes().prod();
}

/// Returns the share of the motions in an area after which the error of an edge is within the bound.
double share_of_motions(const EdgeBatchBase& batch, std::size_t edge, double area, double bound) {
  using std::numbers::pi;
  const Eigen::MatrixXd information = batch.information(edge);
  const double determinant = information.determinant();
  if (!(determinant > 0) || !(area > 0)) return 0;
  if (information.rows() == 3)
    return std::min(1.0, 4.0 / 3 * pi * std::pow(bound, 1.5) / std::sqrt(determinant) / (area * 2 * pi));
  if (information.rows() == 2) return std::min(1.0, pi * bound / std::sqrt(determinant) / area);
  return 0;
}

}  // namespace

std::size_t most_by_chance(const Graph& graph, std::span<const EdgePlace> edges, double bound) {
  constexpr double kProbability = 0.01;
  const double area = area_of_poses(graph);
  double expected = 0;  // that agree with one edge
  for (const EdgePlace place : edges)
    expected += share_of_motions(graph.batch(place.batch), place.edge, area, bound);
  std::size_t most = 1;  // itself
  if (!(expected > 0)) return most;
  // The probability of more than k events, where `expected` are expected: P(chi2 of 2 (k + 1) < 2 expected).
  const auto more_than = [&](std::size_t k) {
    return 1 - chi_square_tail(2 * expected, static_cast<int>(2 * (k + 1)));
  };
  while (most < edges.size() && static_cast<double>(edges.size()) * more_than(most - 1) > kProbability)
    ++most;
  return most;
}

}  // namespace waymark::detail
