// Levenberg-Marquardt in a curved valley: damped steps crawl along it, full ones cross over it.
#include <array>
#include <string_view>

#include <catch2/catch.hpp>

#include <waymark/core/optimize/optimizer.hpp>

#include "support/registry.hpp"
#include "support/scalar_types.hpp"

namespace levenberg_marquardt_test {

using namespace waymark;
using namespace waymark_test;

namespace {

/// Rosenbrock's valley: e = (sharpness (y - x^2), 1 - x), with its minimum 0 at (1, 1).
struct EdgeValley {
  static constexpr std::string_view kTag = "EDGE_VALLEY";
  static constexpr std::string_view kForm = "valley";
  static constexpr int kErrorDimension = 2;
  using Vertices = VertexList<VertexScale, VertexScale>;
  static constexpr auto fields() { return std::array{field<&EdgeValley::sharpness>("sharpness")}; }

  template <typename T>
  Eigen::Matrix<T, 2, 1> error(const T& x, const T& y) const {
    return Eigen::Matrix<T, 2, 1>(T(T(sharpness) * (y - x * x)), T(T(1.0) - x));
  }

  double sharpness = 1;
};

Graph valley(double sharpness) {
  Graph graph;
  const VertexIndex x = graph.add_vertex<VertexScale>(VertexId{0}, {-1.2});
  const VertexIndex y = graph.add_vertex<VertexScale>(VertexId{1}, {1.44});  // on the floor
  graph.add_edge(EdgeValley{sharpness}, {x, y}, Eigen::Matrix2d::Identity());
  return graph;
}

Summary run(Graph& graph) {
  OptimizerOptions options;
  options.max_iterations = 2000;
  return optimize(graph, *registry().make_algorithm("levenberg_marquardt"),
                  *registry().make_linear_solver("eigen"), options);
}

}  // namespace

TEST_CASE("levenberg_marquardt: in a curved valley full steps may climb first, and the minimum is near") {
  // Two full steps reach the minimum from anywhere: the first one ends at x = 1 with y off, the second
  // mends y. Damped steps that never climb need more of them the sharper the valley is.
  for (const double sharpness : {1e2, 1e3, 1e4, 1e5}) {
    INFO("sharpness " << sharpness);
    Graph graph = valley(sharpness);
    const Summary summary = run(graph);
    INFO(summary.message);
    CHECK(summary.converged());
    CHECK(graph.value(0)[0] == Approx(1).margin(1e-6));
    CHECK(graph.value(1)[0] == Approx(1).margin(1e-6));
    CHECK(summary.iterations < 60);
  }
}

}  // namespace levenberg_marquardt_test
