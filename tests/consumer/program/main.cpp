// A program outside the tree: it reads a graph, finds its minimum with a built-in solver, compares with what
// it must be.
#include <cmath>
#include <cstdio>

#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/plugins/builtin.hpp>
#include <waymark/solvers/register.hpp>
#include <waymark/types_se2/register.hpp>

int main() {
  waymark::TypeRegistry registry;
  waymark::register_core_types(registry);
  waymark::register_se2_types(registry);
  waymark::solvers::register_solvers(registry);
  waymark::plugins::register_builtin_plugins(registry);

  // 2 m/s for 3 s straight ahead from a known pose.
  waymark::formats::GraphDocument document = waymark::formats::read_graph(
      "GRAPH 1\nVERTEX_SE2 1 0 0 0\nVERTEX_SE2 2 5 1 0.1\nFIX 1\n"
      "EDGE_SE2_ODOMETRY 1 2 2 0 3 400 0 0 400 0 90000\n",
      "consumer", registry);
  const auto algorithm = registry.make_algorithm("gauss_newton");
  for (const auto& [type, origin] : registry.linear_solvers()) {
    const auto solver = registry.make_linear_solver(type.name);
    waymark::Graph graph = document.graph;
    const waymark::Summary summary = optimize(graph, *algorithm, *solver, {});
    const auto pose = graph.value(*graph.find(waymark::VertexId{2}));
    std::printf("%s: %s: %.6f %.6f %.6f\n", type.name.c_str(), summary.message.c_str(), pose[0], pose[1],
                pose[2]);
    if (!summary.converged() || std::hypot(pose[0] - 6, pose[1], pose[2]) > 1e-6) return 1;
  }
  return 0;
}
