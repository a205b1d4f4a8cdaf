// optimize(graph, how): its choices, its texts, its refusals.
#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/core/system/gauge.hpp>
#include <waymark/solvers/optimize.hpp>

#include "support/problems.hpp"
#include "support/registry.hpp"

namespace optimize_test {

using namespace waymark;
using namespace waymark_test;
using Catch::Contains;

TEST_CASE("front door: one call does what the program does") {
  Graph by_hand = noisy_circle(60);
  const TypeRegistry registry = full_registry();
  const MultiStartSummary expected =
      optimize_from_best_start(by_hand, registry.starts(), *registry.make_algorithm("dogleg"),
                               *registry.make_linear_solver("block_cholesky"), {});
  Graph graph = noisy_circle(60);
  const MultiStartSummary summary = optimize(graph);
  CHECK(summary.converged());
  CHECK(summary.start == expected.start);
  CHECK(summary.summary.algorithm == "dogleg");
  CHECK(graph.values() == by_hand.values());
}

TEST_CASE("front door: start, algorithm and solver can be named") {
  Graph graph = noisy_circle(30);
  const MultiStartSummary summary =
      optimize(graph, {.start = "odometry", .algorithm = "gauss_newton", .solver = "eigen"});
  CHECK(summary.converged());
  CHECK(summary.start == "odometry");
  CHECK_THROWS_AS(optimize(graph, {.start = "nowhere"}), UsageError);
  CHECK_THROWS_AS(optimize(graph, {.algorithm = "newton"}), UsageError);
  CHECK_THROWS_AS(optimize(graph, {.solver = "lu"}), UsageError);
  CHECK_THROWS_AS(optimize(graph, TypeRegistry(), {}), UsageError);
}

TEST_CASE("front door: a summary prints itself briefly and in full") {
  Summary summary;
  summary.message = "converged: no reason";
  summary.initial_chi2 = 1234.5;
  summary.final_chi2 = 1.0 / 3;
  summary.iterations = 1;
  summary.solver = "chains";
  summary.ordering = "natural";
  summary.error_forms = "EDGE_SE2 (t, theta)";
  summary.vertices = 2;
  summary.edges = 1;
  summary.unknowns = 3;
  summary.factor_size = 6;
  summary.total_seconds = 0.0126;
  CHECK(summary.brief() == "converged: no reason; chi2 1234.5 -> 0.3333333333 in 1 iteration");
  CHECK(summary.full() ==
        "converged: no reason\n"
        "chi2        1234.5 -> 0.3333333333   (errors: EDGE_SE2 (t, theta))\n"
        "iterations  1   solver chains, ordering natural\n"
        "size        2 vertices, 1 edges, 3 unknowns, 6 numbers in the factor\n"
        "time        0.013 s (structure 0.000, linearise 0.000, solve 0.000)\n");
  MultiStartSummary several{.summary = summary, .start = "linear", .trials = {{}, {}}, .total_seconds = 1};
  CHECK_THAT(several.full(), Contains("iterations  1   initial guess linear, solver"));
  CHECK_THAT(several.full(), Contains("guesses     1.000 s for 2 initial guesses\n"));
}

TEST_CASE("front door: a kept structure that does not follow the graph is refused") {
  Graph graph = noisy_circle(20);
  const TypeRegistry registry = full_registry();
  const auto algorithm = registry.make_algorithm("gauss_newton");
  const auto solver = registry.make_linear_solver("block_cholesky");
  StructuredSolver kept(*solver);
  CHECK_THROWS_WITH(optimize(graph, kept, *algorithm, {}), Contains("does not follow the graph"));
  kept.build(graph, find_gauge(graph).held);
  CHECK(optimize(graph, kept, *algorithm, {}).converged());
  graph.add_vertex<VertexSe2>(VertexId{100}, {0, 0, 0});
  CHECK_THROWS_WITH(optimize(graph, kept, *algorithm, {}), Contains("does not follow the graph"));
  kept.extend(graph, find_gauge(graph).held);
  CHECK(optimize(graph, kept, *algorithm, {}).converged());
}

}  // namespace optimize_test
