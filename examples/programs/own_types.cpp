// An own vertex and an own edge: wheel odometry whose scale is wrong by a few percent, calibrated
// by fixes.
#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>

#include <waymark/core/covariance/marginals.hpp>
#include <waymark/core/graph/scalar_state.hpp>
#include <waymark/solvers/optimize.hpp>
#include <waymark/types_se2/edge_gnss.hpp>
#include <waymark/types_se2/edge_se2.hpp>

using namespace waymark;

namespace {

/// True length by measured length.
struct VertexWheelScale : ScalarState {
  static constexpr std::string_view kTag = "VERTEX_WHEEL_SCALE";
  static constexpr bool kDense = true;  // every odometry edge touches it
  static constexpr std::array<std::string_view, 1> value_names() { return {"scale"}; }
};

/// The wheels say "length, then turn". Error: the motion between the poses minus the scaled one.
/// Derivatives come by themselves, because error() is generic in its scalar.
struct EdgeWheels {
  static constexpr std::string_view kTag = "EDGE_WHEELS";
  static constexpr std::string_view kForm = "(t, theta)";
  static constexpr int kErrorDimension = 3;
  using Vertices = VertexList<VertexSe2, VertexWheelScale, VertexSe2>;
  static constexpr auto fields() {
    return std::array{field<&EdgeWheels::length>("length"), field<&EdgeWheels::turn>("turn")};
  }

  template <typename T>
  Vector3<T> error(const Pose2<T>& from, const T& scale, const Pose2<T>& to) const {
    const Pose2<T> moved = between(from, to);
    return {T(moved.position[0] - scale * T(length)), moved.position[1],
            wrap_angle(T(moved.heading - T(turn)))};
  }

  double length = 0;  ///< m
  double turn = 0;    ///< rad
};

}  // namespace

int main() {
  constexpr double kTrueScale = 1.03;
  constexpr double kTurn = 0.05;
  Graph graph;
  const VertexIndex origin = graph.add_vertex<VertexSe2>(VertexId{1000}, {0, 0, 0});
  graph.set_fixed(origin, true);
  const VertexIndex scale = graph.add_vertex<VertexWheelScale>(VertexId{1001}, {1.0});

  const Eigen::Matrix3d wheels = Eigen::Vector3d(400, 400, 40000).asDiagonal();
  const Eigen::Matrix2d fix = Eigen::Matrix2d::Identity() / (0.5 * 0.5);  // sigma 0.5 m
  Pose2<double> truth(0, 0, 0);
  for (int i = 0; i < 200; ++i) {
    const VertexIndex pose = graph.add_vertex<VertexSe2>(VertexId{i}, truth);
    if (i > 0) graph.add_edge(EdgeWheels{1 / kTrueScale, kTurn}, {pose - 1, scale, pose}, wheels);
    if (i % 10 == 0) {
      graph.add_edge(
          EdgeGnssPosition{truth.position + Eigen::Vector2d(0.2 * std::sin(i), 0.2 * std::cos(3 * i)),
                           {0, 0}},
          {origin, pose}, fix);
    }
    truth = compose(truth, Pose2<double>(1, 0, kTurn));
  }

  const MultiStartSummary summary = optimize(graph);
  const double found = graph.value<VertexWheelScale>(scale);
  const double sigma = std::sqrt(marginal_covariances(graph, std::array{scale})[0](0, 0));
  std::printf("%swheel scale %.4f +- %.4f (true: %.2f)\n", summary.full().c_str(), found, sigma, kTrueScale);
  return summary.converged() && std::abs(found - kTrueScale) < 3 * sigma && sigma < 0.02 ? 0 : 1;
}
