// In a curved valley damped and truncated steps crawl along it, and full ones cross over it.
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/core/optimize/optimizer.hpp>

#include "support/problems.hpp"
#include "support/registry.hpp"
#include "support/scalar_types.hpp"

namespace curved_valley_test {

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

/// Streets that are driven row by row, there and back, with an edge to the neighbour in the row before. The
/// initial guess is the odometry.
Graph streets(int side, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  constexpr double kSigma_m = 0.1;
  constexpr double kSigma_rad = 0.15;
  const Eigen::Matrix3d information = pose_information(kSigma_m, kSigma_rad);
  std::vector<Pose2<double>> truth;
  for (int i = 0; i < side * side; ++i) {
    const int row = i / side;
    const int column = row % 2 == 0 ? i % side : side - 1 - i % side;
    truth.emplace_back(column, row, std::uniform_real_distribution<double>(-3, 3)(random));
  }
  const auto measured = [&](std::size_t from, std::size_t to) {
    return noisy(between(truth[from], truth[to]).vector(), kSigma_m, kSigma_rad, random);
  };
  Graph graph;
  Pose2<double> reckoned = truth[0];
  for (int i = 0; i < side * side; ++i) {
    const auto z = i == 0 ? Eigen::Vector3d(0, 0, 0)
                          : measured(static_cast<std::size_t>(i) - 1, static_cast<std::size_t>(i));
    reckoned = compose(reckoned, constant_pose<double>(z));
    graph.add_vertex<VertexSe2>(VertexId{i},
                                {reckoned.position[0], reckoned.position[1], wrap_angle(reckoned.heading)});
    if (i > 0) graph.add_edge(EdgeSe2{z}, {i - 1, i}, information);
  }
  for (int i = 0; i + side < side * side; ++i) {
    const int below = 2 * side * (i / side + 1) - 1 - i;
    if (below == i + 1) continue;
    graph.add_edge(EdgeSe2{measured(static_cast<std::size_t>(i), static_cast<std::size_t>(below))},
                   {i, below}, information);
  }
  graph.set_fixed(0, true);
  return graph;
}

Summary run(Graph& graph, const std::string& algorithm = "levenberg_marquardt") {
  OptimizerOptions options;
  options.max_iterations = 2000;
  return optimize(graph, *registry().make_algorithm(algorithm), *registry().make_linear_solver("eigen"),
                  options);
}

}  // namespace

TEST_CASE("curved valley: full steps may climb first, and the minimum is near") {
  // Two full steps reach the minimum from anywhere: the first one ends at x = 1 with y off, the second
  // mends y. Short steps that never climb need more of them the sharper the valley is.
  for (const char* algorithm : {"levenberg_marquardt", "dogleg"}) {
    for (const double sharpness : {1e2, 1e3, 1e4, 1e5}) {
      INFO(algorithm << ", sharpness " << sharpness);
      Graph graph = valley(sharpness);
      const Summary summary = run(graph, algorithm);
      INFO(summary.message);
      CHECK(summary.converged());
      CHECK(graph.value(0)[0] == Approx(1).margin(1e-6));
      CHECK(graph.value(1)[0] == Approx(1).margin(1e-6));
      CHECK(summary.iterations < 60);
    }
  }
}

TEST_CASE(
    "curved valley: a long chain that was measured twice is straightened by the dogleg in tens of steps") {
  // No edge leaps over a vertex, so each pair has a minimum of its own, and chi2 is their sum.
  constexpr int kPoses = 4000;
  constexpr double kSigma_m = 0.05;
  constexpr double kSigma_rad = 0.1;
  std::mt19937_64 random(3);
  const Eigen::Matrix3d information = pose_information(kSigma_m, kSigma_rad);
  Graph graph;
  Pose2<double> reckoned(0, 0, 0);
  double least = 0;
  graph.add_vertex<VertexSe2>(VertexId{0}, {0, 0, 0});
  for (int i = 1; i < kPoses; ++i) {
    const Eigen::Vector3d truth(1, 0, 0.02 * std::sin(i / 50.0));
    const std::array measured{noisy(truth, kSigma_m, kSigma_rad, random),
                              noisy(truth, kSigma_m, kSigma_rad, random)};
    reckoned = compose(reckoned, constant_pose<double>(measured[0]));
    const Pose2<double> first = constant_pose<double>(measured[0]);
    graph.add_vertex<VertexSe2>(VertexId{i},
                                {reckoned.position[0], reckoned.position[1], wrap_angle(reckoned.heading)});
    Graph pair;
    pair.add_vertex<VertexSe2>(VertexId{0}, {0, 0, 0});
    pair.add_vertex<VertexSe2>(VertexId{1}, {first.position[0], first.position[1], first.heading});
    pair.set_fixed(0, true);
    for (const Eigen::Vector3d& z : measured) {
      graph.add_edge(EdgeSe2{z}, {i - 1, i}, information);
      pair.add_edge(EdgeSe2{z}, {0, 1}, information);
    }
    least += run(pair, "gauss_newton").final_chi2;
  }
  graph.set_fixed(0, true);
  const Summary summary = run(graph, "dogleg");
  INFO(summary.message << ", " << summary.iterations << " iterations");
  CHECK(summary.converged());
  CHECK(summary.final_chi2 == Approx(least).epsilon(1e-6));
  CHECK(summary.iterations < 60);
}

TEST_CASE(
    "curved valley: a graph that is bent as a whole is straightened by Levenberg-Marquardt, and not folded by damping") {
  // chi2 of the true minimum is chi-square distributed. Where full steps alone reach it, this algorithm must.
  int reached = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    INFO("seed " << seed);
    Graph graph = streets(60, seed);
    Graph by_full_steps = graph;
    const double freedom = 3.0 * static_cast<double>(graph.edge_count() + 1 - graph.vertex_count());
    const double plausible = freedom + 5 * std::sqrt(2 * freedom);
    if (run(by_full_steps, "gauss_newton").final_chi2 > plausible) continue;
    ++reached;
    const Summary summary = run(graph);
    CHECK(summary.converged());
    CHECK(summary.final_chi2 < plausible);
  }
  CHECK(reached > 0);
}

}  // namespace curved_valley_test
