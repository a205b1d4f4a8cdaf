// A robot drives round a square and recognises its starting corner: four poses, four odometry edges, one
// minimum.
#include <cstdio>
#include <numbers>

#include <waymark/core/covariance/marginals.hpp>
#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/solvers/register.hpp>
#include <waymark/types_se2/edge_se2.hpp>

int main() {
  using namespace waymark;
  TypeRegistry registry;
  solvers::register_solvers(registry);

  // Vertices with rough values; the first is fixed, so that the square has a place.
  constexpr double kRight = std::numbers::pi / 2;
  Graph graph;
  const VertexIndex a = graph.add_vertex<VertexSe2>(1, {0.0, 0.0, 0.0});
  const VertexIndex b = graph.add_vertex<VertexSe2>(2, {9.7, 0.4, 1.5});
  const VertexIndex c = graph.add_vertex<VertexSe2>(3, {10.3, 9.5, 3.0});
  const VertexIndex d = graph.add_vertex<VertexSe2>(4, {0.5, 10.4, -1.6});
  graph.set_fixed(a, true);

  // "10 m forward, then a quarter turn left" four times, with sigma 10 cm and 1 degree. The measured sides
  // differ.
  const Eigen::Matrix3d information = Eigen::Vector3d(100, 100, 3283).asDiagonal();
  graph.add_edge(EdgeSe2{{10.1, 0, kRight}}, {a, b}, information);
  graph.add_edge(EdgeSe2{{9.9, 0, kRight}}, {b, c}, information);
  graph.add_edge(EdgeSe2{{10.0, 0, kRight}}, {c, d}, information);
  graph.add_edge(EdgeSe2{{10.2, 0, kRight}}, {d, a}, information);

  const auto algorithm = registry.make_algorithm("dogleg");
  const auto solver = registry.make_linear_solver("eigen");
  const Summary summary = optimize(graph, *algorithm, *solver, {});
  std::printf("%s\nchi2 %.4f -> %.4f\n", summary.message.c_str(), summary.initial_chi2, summary.final_chi2);

  const VertexIndex corners[] = {b, c, d};
  const auto covariances = marginal_covariances(graph, corners);
  for (int i = 0; i < 3; ++i) {
    const auto pose = graph.value(corners[i]);
    std::printf("pose %lld: x %.3f y %.3f heading %.3f, sigma_x %.3f m\n",
                static_cast<long long>(graph.id(corners[i])), pose[0], pose[1], pose[2],
                std::sqrt(covariances[static_cast<std::size_t>(i)](0, 0)));
  }
  return summary.converged() ? 0 : 1;
}
