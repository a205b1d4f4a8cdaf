#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include <Eigen/Geometry>

#include <waymark/core/graph/checks/edge_type_check.hpp>
#include <waymark/core/graph/detail/sight_check.hpp>

namespace waymark::detail {
namespace {

using Point = std::array<double, 2>;

/// Returns points of a sight, in the axes of the pose.
std::vector<Eigen::Vector2d> points_of(const Sight& sight) {
  std::vector<Eigen::Vector2d> points = {sight.place()};
  if (!sight.has_range) {
    for (const double along : {0.5, 3.0}) points.emplace_back(sight.sensor + along * sight.way);
  }
  if (!sight.has_bearing) {
    for (const double turn : {1.0, 2.5, -2.0})
      points.emplace_back(sight.sensor + Eigen::Rotation2Dd(turn) * sight.way);
  }
  return points;
}

double error_at(Graph& graph, const Eigen::Vector3d& pose, const Eigen::Vector2d& seen) {
  const Eigen::Vector2d point = pose.head<2>() + Eigen::Rotation2Dd(pose[2]) * seen;
  graph.set_value(0, std::array{pose[0], pose[1], pose[2]});
  graph.set_value(1, Point{point[0], point[1]});
  Eigen::VectorXd error;
  std::vector<Eigen::MatrixXd> jacobians;
  graph.batch(0).linearize_edge(0, graph.view(), error, jacobians);
  return error.allFinite() ? error.cwiseAbs().maxCoeff() : std::numeric_limits<double>::infinity();
}

}  // namespace

double sight_error_of(const TypeRegistry& registry, const EdgeType& type) {
  constexpr int kTrials = 20;
  if (type.arity != 2) return 0;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0.1, 1);
  double worst = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Graph drawn = single_edge(registry, type, edge_scenarios().back(), random);
    if (drawn.vertex_type(0).value_size != 3 || drawn.vertex_type(1).value_size != 2) return 0;
    Graph graph;
    for (const VertexIndex v : {0, 1}) graph.add_vertex(drawn.vertex_type(v), drawn.id(v), drawn.value(v));
    std::vector<double> fields(static_cast<std::size_t>(type.field_size()));
    std::generate(fields.begin(), fields.end(), [&] { return unit(random); });
    const std::array<VertexIndex, 2> vertices{0, 1};
    graph.add_edge(type, vertices, fields, drawn.batch(0).information(0));
    const std::optional<Sight> sight = graph.batch(0).sight(0);
    if (!sight) return 0;
    const Eigen::Vector3d moved(3 * unit(random), -unit(random), 2 * unit(random));
    for (const Eigen::Vector2d& point : points_of(*sight)) {
      worst = std::max(worst, error_at(graph, Eigen::Vector3d::Zero(), point));
      worst = std::max(worst, error_at(graph, moved, point));
    }
  }
  return worst;
}

}  // namespace waymark::detail
