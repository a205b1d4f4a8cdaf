// Every algorithm with every linear solver on small problems made in code: one minimum, verified by
// its gradient.
#include <cmath>

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>

#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/core/system/gauge.hpp>

#include "support/dense.hpp"
#include "support/problems.hpp"
#include "support/registry.hpp"

using namespace waymark;
using namespace waymark_test;

namespace {

/// Runs all pairs from the same start; each must converge to a point where the gradient vanishes,
/// and all to the same one.
void check_all_pairs(const Graph& start) {
  const TypeRegistry registry = full_registry();
  OptimizerOptions options;
  options.decrement_tolerance = 1e-10;  // under robust losses the last steps are short
  double common = -1;
  std::vector<double> values;
  for (const auto& [algorithm, algorithm_origin] : registry.algorithms()) {
    for (const auto& [solver, solver_origin] : registry.linear_solvers()) {
      INFO(algorithm.name << " with " << solver.name);
      Graph graph = start;
      const Summary summary = optimize(graph, *registry.make_algorithm(algorithm.name),
                                       *registry.make_linear_solver(solver.name), options);
      INFO(summary.message);
      REQUIRE(summary.converged());
      const DenseSystem system = assemble_dense(graph, find_gauge(graph).held);
      const Eigen::LLT<Eigen::MatrixXd> factor(system.hessian);
      REQUIRE(factor.info() == Eigen::Success);
      CHECK(system.gradient.dot(factor.solve(system.gradient)) < 1e-9 * (1 + summary.final_chi2));
      if (common < 0) {
        common = summary.final_chi2;
        values = graph.values();
      }
      CHECK(summary.final_chi2 == Approx(common).epsilon(1e-9));
      for (std::size_t i = 0; i < values.size(); ++i)
        REQUIRE(graph.values()[i] == Approx(values[i]).margin(1e-4));
    }
  }
}

}  // namespace

TEST_CASE("every algorithm with every solver: a noisy circle with closures, from its odometry") {
  check_all_pairs(noisy_circle(60));
}

TEST_CASE("every algorithm with every solver: a walk on a grid") {
  check_all_pairs(grid_walk(200, 8));
}

TEST_CASE("every algorithm with every solver: a drive with fixes, each modeling") {
  const TypeRegistry registry = full_registry();
  for (const auto& [modeling, origin] : registry.gnss_modelings()) {
    INFO(modeling.name);
    Drive drive = make_drive(registry, 250);
    drive.add_fixes(registry, modeling.name);
    check_all_pairs(drive.graph);
  }
}

TEST_CASE("every algorithm with every solver: robust losses") {
  const TypeRegistry registry = full_registry();
  for (const char* name : {"huber", "cauchy"}) {
    INFO(name);
    Graph graph = noisy_circle(40);
    graph.add_edge(EdgeSe2{{3, 3, 2}}, {4, 30}, pose_information(0.05, 0.01));  // an outlier
    const LossType* loss = registry.find_loss(name);
    graph.batch(0).set_loss(Loss{loss->name, loss->evaluate, 1.5});
    for (const auto& [algorithm, algorithm_origin] : registry.algorithms()) {
      if (algorithm.name == "gauss_newton") continue;  // full steps may cycle if weights change
      INFO(algorithm.name);
      Graph copy = graph;
      OptimizerOptions options;
      options.decrement_tolerance = 1e-10;  // weights that change make the last steps small ones
      const Summary summary = optimize(copy, *registry.make_algorithm(algorithm.name),
                                       *registry.make_linear_solver("eigen"), options);
      INFO(summary.message);
      CHECK(summary.converged());
      const DenseSystem system = assemble_dense(copy, find_gauge(copy).held);
      const Eigen::LLT<Eigen::MatrixXd> factor(system.hessian);
      CHECK(system.gradient.dot(factor.solve(system.gradient)) < 1e-9 * (1 + summary.final_chi2));
    }
  }
}

TEST_CASE("every algorithm with every solver: noise-free measurements are met exactly") {
  const TypeRegistry registry = full_registry();
  for (const auto& [algorithm, algorithm_origin] : registry.algorithms()) {
    for (const auto& [solver, solver_origin] : registry.linear_solvers()) {
      INFO(algorithm.name << " with " << solver.name);
      Graph graph;
      for (int i = 0; i < 20; ++i) {
        graph.add_vertex<VertexSe2>(VertexId(i),
                                    {1.0 * i + 0.1 * std::sin(3.0 * i), 0.2 * std::cos(2.0 * i), 0.05});
      }
      for (int i = 1; i < 20; ++i)
        graph.add_edge(EdgeSe2{{1, 0, 0.3}}, {i - 1, i}, pose_information(0.1, 0.1));
      for (int i = 3; i < 20; i += 3) {
        Pose2<double> z;
        for (int k = 0; k < 3; ++k) z = compose(z, Pose2<double>(1, 0, 0.3));
        graph.add_edge(EdgeSe2Log{z.vector()}, {i - 3, i}, pose_information(0.1, 0.1));
      }
      const Summary summary = optimize(graph, *registry.make_algorithm(algorithm.name),
                                       *registry.make_linear_solver(solver.name), {});
      INFO(summary.message);
      CHECK(summary.converged());
      CHECK(summary.final_chi2 < 1e-9);
    }
  }
}
