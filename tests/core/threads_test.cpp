// Results do not depend on the number of threads, nor on the run: whole optimisations of problems
// of several chunks, compared bit by bit, with every registered solver.
#include <cstring>

#include <catch2/catch.hpp>

#include <waymark/core/optimize/optimizer.hpp>

#include "support/calibrated_drive.hpp"
#include "support/registry.hpp"

namespace threads_test {

using namespace waymark;
using namespace waymark_test;

namespace {

constexpr int kPoses = 10'000;  // three chunks of vertices

struct Problem {
  std::string name;
  Graph graph;
};

Graph drive(const TypeRegistry& registry, const char* modeling) {
  Drive made = make_drive(registry, kPoses);
  made.add_fixes(registry, modeling);
  return std::move(made.graph);
}

Graph robust_grid(const TypeRegistry& registry) {
  Graph graph = grid_walk(kPoses, 90);
  const auto loss = [&](const char* name, double scale) {
    return Loss{name, registry.find_loss(name)->evaluate, scale};
  };
  graph.batch(0).set_loss(loss("cauchy", 1.5));
  for (std::size_t e = 0; e < graph.batch(0).size(); e += 7) graph.batch(0).set_loss(e, loss("huber", 0.5));
  return graph;
}

/// Fixed vertices in every chunk, points among them that are smaller than the poses beside them;
/// one part floats, so that the gauge holds one of its poses.
Graph grid_with_fixed(const TypeRegistry&) {
  Graph graph = grid_walk(kPoses, 90);
  for (int i = 5; i < kPoses; i += 500) graph.set_fixed(i, true);
  for (int i = 0; i < kPoses; i += 100) {
    const auto at = graph.value(i);
    const VertexIndex point = graph.add_vertex<VertexXy>(VertexId(100'000 + i), {at[0] + 1, at[1]});
    graph.set_fixed(point, i % 300 == 0);
    graph.add_edge(EdgeSe2Xy{{1, 0.1}}, {i, point}, Eigen::Matrix2d::Identity());
    graph.add_edge(EdgeSe2Xy{{1, -0.1}}, {i + 1, point}, Eigen::Matrix2d::Identity());
  }
  VertexIndex last = -1;
  for (int i = 0; i < 5000; ++i) {
    const VertexIndex pose = graph.add_vertex<VertexSe2>(VertexId(200'000 + i), {0.9 * i, 0.1, 0.0001 * i});
    if (last >= 0) graph.add_edge(EdgeSe2{{1, 0, 0.001}}, {last, pose}, pose_information(0.1, 0.02));
    last = pose;
  }
  return graph;
}

std::vector<Problem> problems(const TypeRegistry& registry) {
  std::vector<Problem> made;
  made.push_back({"drive under G1", drive(registry, "g1")});
  made.push_back({"drive under G2", drive(registry, "g2")});
  made.push_back({"drive with a dense calibration state", calibrated_drive(registry, kPoses)});
  made.push_back({"grid with loops", grid_walk(kPoses, 90)});
  made.push_back({"grid with robust losses", robust_grid(registry)});
  made.push_back({"grid with fixed vertices and a floating part", grid_with_fixed(registry)});
  return made;
}

struct Result {
  std::vector<double> values;
  double chi2 = 0;
  int iterations = 0;
};

Result run(const TypeRegistry& registry, const Graph& start, const std::string& algorithm,
           const std::string& solver, int threads) {
  Graph graph = start;
  OptimizerOptions options;
  options.threads = threads;
  options.max_iterations = 2;
  const Summary summary =
      optimize(graph, *registry.make_algorithm(algorithm), *registry.make_linear_solver(solver), options);
  return {graph.values(), summary.final_chi2, summary.iterations};
}

void check_same(const Result& result, const Result& reference) {
  CHECK(result.iterations == reference.iterations);
  CHECK(std::memcmp(&result.chi2, &reference.chi2, sizeof(double)) == 0);
  REQUIRE(result.values.size() == reference.values.size());
  CHECK(std::memcmp(result.values.data(), reference.values.data(), result.values.size() * sizeof(double)) ==
        0);
}

}  // namespace

TEST_CASE("threads: values, chi2 and iterations are the same bits for 1, 2 and 3 threads with every solver") {
  const TypeRegistry registry = full_registry();
  for (const Problem& problem : problems(registry)) {
    INFO(problem.name);
    for (const auto& [solver, origin] : registry.linear_solvers()) {
      INFO(solver.name);
      // The algorithm matters only to the solver with threads of its own.
      std::vector<std::string> algorithms = {"dogleg"};
      if (solver.name == "block_cholesky") algorithms.emplace_back("gauss_newton");
      for (const std::string& algorithm : algorithms) {
        INFO(algorithm);
        const Result reference = run(registry, problem.graph, algorithm, solver.name, 1);
        CHECK(reference.iterations > 0);
        for (const int threads : {1, 2, 2, 3, 3})
          check_same(run(registry, problem.graph, algorithm, solver.name, threads), reference);
      }
    }
  }
}

}  // namespace threads_test
