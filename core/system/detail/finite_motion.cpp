#include <algorithm>
#include <cmath>
#include <vector>

#include <waymark/core/linear/dense_decompositions.hpp>
#include <waymark/core/system/detail/components.hpp>
#include <waymark/core/system/detail/finite_motion.hpp>

namespace waymark::detail {
namespace {

/// Returns the least d that makes |a d + b| smallest.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  constexpr double kNothing = 1e-9;
  const SingularValues svd = singular_values(a);
  Eigen::VectorXd result = Eigen::VectorXd::Zero(a.cols());
  for (Eigen::Index i = 0; i < svd.values.size(); ++i) {
    if (svd.values[i] > kNothing * svd.values[0])
      result -= svd.left.col(i).dot(b) / svd.values[i] * svd.right.col(i);
  }
  return result;
}

/// Returns the motion that does one motion after another.
FiniteMotion followed(const FiniteMotion& first, const FiniteMotion& then) {
  return {first.turn + then.turn, then.of(first.shift)};
}

/// Returns a turn about a place, then a shift.
FiniteMotion about(const Eigen::Vector2d& place, double turn, const Eigen::Vector2d& shift) {
  return {turn, place + shift - FiniteMotion{.turn = turn}.of(place)};
}

}  // namespace

Eigen::Vector2d FiniteMotion::of(const Eigen::Vector2d& point) const {
  const double c = std::cos(turn);
  const double s = std::sin(turn);
  return shift + Eigen::Vector2d(c * point.x() - s * point.y(), s * point.x() + c * point.y());
}

void move(Graph& graph, VertexIndex v, const FiniteMotion& motion) {
  const VertexType& type = graph.vertex_type(v);
  if (type.rigid_motion == nullptr) return;
  const auto retract = [&](const Eigen::VectorXd& step) {
    std::vector<double> value(graph.value(v).begin(), graph.value(v).end());
    type.retract(value.data(), step.data());
    graph.set_value(v, value);
  };
  // Of large motions only a turn of the vertex about its own place and a shift are steps of its tangent.
  const Eigen::Vector2d place = type.position(graph.value(v).data());
  retract(own_turn(graph, v) * motion.turn);
  retract(motion_of(graph, v, {}).leftCols<2>() * (motion.of(place) - place));
}

std::optional<FiniteMotion> motion_to_agree(const EdgeBatchBase& batch, std::size_t edge, Graph& graph,
                                            std::span<const VertexIndex> moved) {
  constexpr int kSteps = 10;
  constexpr double kNoStep = 1e-12;  // of metres and radians
  std::vector<std::vector<double>> before;
  for (const VertexIndex v : moved) {
    if (graph.vertex_type(v).rigid_motion == nullptr) return std::nullopt;
    before.emplace_back(graph.value(v).begin(), graph.value(v).end());
  }
  const std::span<const VertexIndex> vertices = batch.vertices(edge);
  const RigidMotionView::Place place{graph.vertex_type(moved[0]).position(before[0].data()), 1};
  FiniteMotion motion;
  Eigen::VectorXd error;
  std::vector<Eigen::MatrixXd> jacobians;
  for (int step = 0; step < kSteps; ++step) {
    batch.linearize_edge(edge, graph.view(), error, jacobians);
    Eigen::MatrixXd by_motion = Eigen::MatrixXd::Zero(error.size(), 3);
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      if (std::find(moved.begin(), moved.end(), vertices[k]) != moved.end())
        by_motion += jacobians[k] * motion_of(graph, vertices[k], place);
    }
    if (!by_motion.allFinite() || !error.allFinite()) break;
    const Eigen::VectorXd way = least_squares(by_motion, error);
    const FiniteMotion next = about(place.centre, way[2], way.head<2>());
    for (const VertexIndex v : moved) move(graph, v, next);
    motion = followed(motion, next);
    if (way.norm() <= kNoStep * (1 + motion.shift.norm())) break;
  }
  for (std::size_t i = 0; i < moved.size(); ++i) graph.set_value(moved[i], before[i]);
  if (!std::isfinite(motion.turn) || !motion.shift.allFinite() || !error.allFinite()) return std::nullopt;
  return motion;
}

}  // namespace waymark::detail
