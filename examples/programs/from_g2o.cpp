// What a pose-graph program for g2o, GTSAM or Ceres becomes: poses, an edge of one's own, and a minimum that
// is known by hand.
#include <array>
#include <cmath>
#include <cstdio>

#include <waymark/solvers/optimize.hpp>
#include <waymark/types_se2/edge_se2.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

using namespace waymark;

// The distance to a landmark, as a radio beacon measures it.
struct EdgeBeacon {
  static constexpr std::string_view kTag = "EDGE_BEACON";
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexSe2, VertexXy>;
  static constexpr auto fields() { return std::array{field<&EdgeBeacon::range>("range")}; }
  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const Pose2<T>& pose, const Vector2<T>& beacon) const {
    const Vector2<T> d = beacon - pose.position;
    return Eigen::Matrix<T, 1, 1>(sqrt(d[0] * d[0] + d[1] * d[1]) - T(range));
  }
  double range = 0;  // m
};

int main() {
  Graph graph;
  const VertexIndex a = graph.add_vertex<VertexSe2>(VertexId{0}, {0.0, 0.0, 0.0});
  const VertexIndex b = graph.add_vertex<VertexSe2>(VertexId{1}, {1.1, 0.1, 0.0});
  const VertexIndex beacon = graph.add_vertex<VertexXy>(VertexId{2}, {1.0, 5.0});
  graph.set_fixed(a, true);
  graph.set_fixed(beacon, true);

  // sigma 0.1 m and 0.05 rad: the information is 1 / sigma^2.
  const Eigen::Matrix3d information = Eigen::Vector3d(100, 100, 400).asDiagonal();
  graph.add_edge(EdgeSe2{{1.0, 0.0, 0.0}}, {a, b}, information);
  // sigma 0.2 m: 1 / 0.04 = 25. The beacon is 5 m to the left of where the odometry ends.
  graph.add_edge(EdgeBeacon{5.1}, {b, beacon}, Eigen::Matrix<double, 1, 1>(25.0));

  const MultiStartSummary summary = optimize(graph);
  const Pose2<double> pose = graph.value<VertexSe2>(b);
  std::printf("chi2 %.4f, y %.4f\n", graph.chi2(), pose.position.y());

  // By hand: along y the odometry says 0 with sigma^2 0.01, the beacon -0.1 with sigma^2 0.04. The minimum is the
  // weighted mean, and chi2 the square of the difference over the sum of the variances, without a factor 1/2.
  const bool right = summary.converged() && std::abs(pose.position.y() + 0.1 * 25 / 125) < 1e-6 &&
                     std::abs(graph.chi2() - 0.01 / 0.05) < 1e-6;
  return right ? 0 : 1;
}
