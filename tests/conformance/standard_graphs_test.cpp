// The published pose graphs: every algorithm with every solver reaches the best optimum known (anchors: the
// best of g2o, Ceres and GTSAM, (t, theta) form). They are not part of the project: skipped if absent.
#include <optional>

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>

#include <waymark/core/optimize/multi_start.hpp>
#include <waymark/core/system/gauge.hpp>
#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/formats/graph/graph_format.hpp>
#include <waymark/formats/text/text_file.hpp>

#include "support/dense.hpp"
#include "support/registry.hpp"
#include "support/skip.hpp"

using namespace waymark;
using namespace waymark::formats;
using namespace waymark_test;

namespace {

std::optional<Graph> load(const std::string& name, const TypeRegistry& registry,
                          bool odometry_start = false) {
  const bool toro = name.ends_with("_toro");
  const auto path = shared_data("graphs/" + name + (toro ? ".graph" : ".g2o"));
  if (!path) return std::nullopt;
  Graph graph =
      read_graph_as(toro ? GraphFormat::toro : GraphFormat::graph, read_text_file(*path), name, registry)
          .graph;
  if (odometry_start) graph.set_values(registry.make_start("odometry", graph).values);
  return graph;
}

Summary run(Graph& graph, const AlgorithmType& algorithm, const LinearSolverType& solver,
            int iterations = 200) {
  OptimizerOptions options;
  options.max_iterations = iterations;
  return optimize(graph, *algorithm.make(CheckedOptions(algorithm.name, {}, algorithm.options)),
                  *solver.make(CheckedOptions(solver.name, {}, solver.options)), options);
}

/// Runs every algorithm with every solver from this graph. @param check is given each minimum
template <typename Check>
void for_each_minimum(const Graph& start, const TypeRegistry& registry, const Check& check) {
  for (const auto& [algorithm, algorithm_origin] : registry.algorithms()) {
    for (const auto& [solver, solver_origin] : registry.linear_solvers()) {
      Graph graph = start;
      const Summary summary = run(graph, algorithm, solver);
      INFO(algorithm.name << " with " << solver.name << ": " << summary.message);
      CHECK(summary.converged());
      check(summary.final_chi2);
    }
  }
}

void check_optimum(const std::string& name, double optimum, bool odometry_start = false) {
  const TypeRegistry registry = full_registry();
  const auto start = load(name, registry, odometry_start);
  if (!start) return;
  for_each_minimum(*start, registry, [&](double chi2) { CHECK(chi2 == Approx(optimum).epsilon(1e-6)); });
}

/// Whether the values are a true local minimum of chi2: no gradient, and a positive definite Hessian that
/// holds the second derivatives of the errors as well (differences of the exact gradient).
void check_local_minimum(const Graph& graph) {
  const Gauge gauge = find_gauge(graph);
  Structure structure;
  structure.build(graph, gauge.held);
  NormalEquations equations(graph, structure);
  equations.linearize(graph.values());
  const auto n = static_cast<Eigen::Index>(structure.pattern().dimension());
  CHECK((equations.gradient().array() / equations.diagonal().array().sqrt()).abs().maxCoeff() < 1e-3);
  Eigen::MatrixXd hessian(n, n);
  std::vector<double> moved;
  constexpr double kStep = 1e-5;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::VectorXd d = kStep * Eigen::VectorXd::Unit(n, i);
    equations.retract(graph.values(), d, moved);
    equations.linearize(moved);
    hessian.col(i) = equations.gradient();
    equations.retract(graph.values(), -d, moved);
    equations.linearize(moved);
    hessian.col(i) -= equations.gradient();
  }
  hessian = Eigen::MatrixXd((hessian + hessian.transpose()) / (4 * kStep));
  CHECK(Eigen::LLT<Eigen::MatrixXd>(hessian).info() == Eigen::Success);
}

}  // namespace

TEST_CASE("standard graphs: manhattan, edges only, from its odometry") {
  check_optimum("manhattan", 3549.0368);
}
TEST_CASE("standard graphs: intel, from its vertices") {
  check_optimum("intel", 45.00470);
}
TEST_CASE("standard graphs: intel, from its odometry") {
  check_optimum("intel", 45.00470, true);
}
TEST_CASE("standard graphs: kitti_00, edges only, from its odometry") {
  check_optimum("kitti_00", 98.32201);
}
TEST_CASE("standard graphs: city10000, from its vertices") {
  check_optimum("city10000", 511.98516);
}
TEST_CASE("standard graphs: ais2klinik, from its vertices") {
  check_optimum("ais2klinik", 172.81558);
}
TEST_CASE("standard graphs: Levenberg-Marquardt crosses the curved valley of ais2klinik") {
  // Ceres needs more than 100 iterations, GTSAM 97 (anchors); damped steps that never climb, 113.
  const TypeRegistry registry = full_registry();
  for (const bool odometry : {false, true}) {
    auto graph = load("ais2klinik", registry, odometry);
    if (!graph) return;
    const Summary summary = optimize(*graph, *registry.make_algorithm("levenberg_marquardt"),
                                     *registry.make_linear_solver("block_cholesky"), {});
    CHECK(summary.converged());
    CHECK(summary.final_chi2 == Approx(172.81558).epsilon(1e-6));
    CHECK(summary.iterations <= 20);
  }
}

TEST_CASE("standard graphs: ring and manhattanOlson3500, one minimum for all") {
  // No published figure: all pairs must agree, and the point must be a minimum by its gradient.
  const TypeRegistry registry = full_registry();
  for (const std::string name : {"ring", "manhattanOlson3500"}) {
    const auto start = load(name, registry);
    if (!start) return;
    double common = -1;
    for_each_minimum(*start, registry, [&](double chi2) {
      if (common < 0) common = chi2;
      CHECK(chi2 == Approx(common).epsilon(1e-6));
    });
  }
}

TEST_CASE("standard graphs: the default configuration reaches every optimum from file and odometry") {
  // MIT: 526.33 was the best published figure. 41.163269 is where Gauss-Newton, Levenberg-Marquardt and
  // dogleg end from both tree and linear starts, and the lowest of 300 runs from perturbed ones.
  const std::pair<const char*, double> graphs[] = {
      {"manhattan", 3549.0368},  {"intel", 45.00470},
      {"kitti_00", 98.32201},    {"city10000", 511.98516},
      {"ais2klinik", 172.81558}, {"MIT", 41.163269},
      {"ring", 11.163101},       {"manhattanOlson3500", 146.076613},
      {"fr079_toro", 37.599116}};
  const TypeRegistry registry = full_registry();
  for (const auto& [name, optimum] : graphs) {
    for (const bool odometry : {false, true}) {
      auto graph = load(name, registry, odometry);
      if (!graph) return;
      const MultiStartSummary result = optimize_from_best_start(
          *graph, registry.starts(), *registry.make_algorithm("dogleg"),
          *registry.make_linear_solver(registry.linear_solvers().front().type.name), {});
      INFO(name << ": " << result.summary.message);
      CHECK(result.summary.converged());
      CHECK(result.summary.final_chi2 == Approx(optimum).epsilon(1e-6));
    }
  }
}

TEST_CASE(
    "standard graphs: MIT, every algorithm reaches its lowest minimum from the starts that read edges") {
  const TypeRegistry registry = full_registry();
  const auto file = load("MIT", registry);
  if (!file) return;
  for (const std::string start : {"linear", "spanning_tree"}) {
    for (const auto& [algorithm, origin] : registry.algorithms()) {
      Graph graph = *file;
      graph.set_values(registry.make_start(start, graph).values);
      const Summary summary = run(graph, algorithm, registry.linear_solvers().front().type);
      CHECK(summary.converged());
      CHECK(summary.final_chi2 == Approx(41.163269).epsilon(1e-6));
      check_local_minimum(graph);
    }
  }
}

TEST_CASE("standard graphs: MIT, dogleg reaches the best known minimum or a better one") {
  const TypeRegistry registry = full_registry();
  const auto start = load("MIT", registry);
  if (!start) return;
  for (const auto& [solver, origin] : registry.linear_solvers()) {
    Graph graph = *start;
    OptimizerOptions options;
    options.max_iterations = 500;
    const Summary summary = optimize(graph, *registry.make_algorithm("dogleg"),
                                     *registry.make_linear_solver(solver.name), options);
    INFO(solver.name << ": " << summary.message);
    CHECK(summary.converged());
    CHECK(summary.final_chi2 <= 526.34);
  }
}

TEST_CASE("standard graphs: MIT, an algorithm that ends elsewhere says so") {
  // 770.66 is where g2o's Gauss-Newton stops as well. Whoever says "converged" must stand at a true local
  // minimum.
  const TypeRegistry registry = full_registry();
  const auto start = load("MIT", registry);
  if (!start) return;
  for (const std::string name : {"gauss_newton", "levenberg_marquardt"}) {
    for (const int iterations : {50, 500}) {
      Graph graph = *start;
      OptimizerOptions options;
      options.max_iterations = iterations;
      const Summary summary =
          optimize(graph, *registry.make_algorithm(name), *registry.make_linear_solver("eigen"), options);
      INFO(name << ": " << summary.message);
      if (!summary.converged()) {
        CHECK(summary.termination == Termination::max_iterations);
      } else if (summary.final_chi2 > 526.34) {
        check_local_minimum(graph);
      }
    }
  }
}
