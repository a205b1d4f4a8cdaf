// A robot drives round a square and recognises its starting corner: four poses, four odometry
// edges, one minimum, and how far it is to be trusted.
#include <cmath>
#include <cstdio>
#include <numbers>

#include <waymark/core/covariance/marginals.hpp>
#include <waymark/solvers/optimize.hpp>
#include <waymark/types_se2/edge_se2.hpp>

int main() {
  using namespace waymark;
  // Vertices with rough values; the first is fixed, so that the square has a place.
  constexpr double kRight = std::numbers::pi / 2;
  Graph graph;
  const VertexIndex a = graph.add_vertex<VertexSe2>(VertexId{1}, {0.0, 0.0, 0.0});
  const VertexIndex b = graph.add_vertex<VertexSe2>(VertexId{2}, {9.7, 0.4, 1.5});
  const VertexIndex c = graph.add_vertex<VertexSe2>(VertexId{3}, {10.3, 9.5, 3.0});
  const VertexIndex d = graph.add_vertex<VertexSe2>(VertexId{4}, {0.5, 10.4, -1.6});
  graph.set_fixed(a, true);

  // "10 m forward, then a quarter turn left" four times, with sigma 10 cm and 1 degree. The
  // measured sides differ.
  const Eigen::Matrix3d information = Eigen::Vector3d(100, 100, 3283).asDiagonal();
  graph.add_edge(EdgeSe2{{10.1, 0, kRight}}, {a, b}, information);
  graph.add_edge(EdgeSe2{{9.9, 0, kRight}}, {b, c}, information);
  graph.add_edge(EdgeSe2{{10.0, 0, kRight}}, {c, d}, information);
  graph.add_edge(EdgeSe2{{10.2, 0, kRight}}, {d, a}, information);

  const MultiStartSummary summary = optimize(graph);
  std::printf("%s", summary.full().c_str());

  const VertexIndex corners[] = {b, c, d};
  const CovarianceBlocks covariances = marginal_covariances(graph, corners);
  bool right = summary.converged() && std::abs(summary.summary.final_chi2 - 1.4131) < 1e-4;
  for (std::size_t i = 0; i < 3; ++i) {
    const Pose2<double> pose = graph.value<VertexSe2>(corners[i]);
    const double sigma_x = std::sqrt(covariances[i](0, 0));
    std::printf("pose %s: x %.3f y %.3f heading %.3f, sigma_x %.3f m\n",
                to_string(graph.id(corners[i])).c_str(), pose.position.x(), pose.position.y(), pose.heading,
                sigma_x);
    right = right && sigma_x > 0 && sigma_x < 0.2;
  }
  return right ? 0 : 1;
}
