// The convergence table of types_se2/start/MEASUREMENTS.md: hidden, because it takes minutes and needs a drive
// that is not part of this repository (support/key_workload.hpp).
//   WAYMARK_KEY_WORKLOAD=DIR waymark_conformance_tests "[.table]"
#include <cstdio>

#include <catch2/catch.hpp>

#include <waymark/core/optimize/multi_start.hpp>

#include "support/key_workload.hpp"
#include "support/registry.hpp"
#include "support/spoiling.hpp"

using namespace waymark;
using namespace waymark_test;

namespace {

constexpr const char* kAlgorithms[] = {"gauss_newton", "levenberg_marquardt", "dogleg"};

/// "6", or what the run ended at.
std::string cell(const Summary& summary, double optimum) {
  char text[80];
  const bool reached = summary.converged() && std::abs(summary.final_chi2 - optimum) < 1e-3;
  if (reached) return std::to_string(summary.iterations);
  std::snprintf(text, sizeof text, "x (%.3g%s)", summary.final_chi2,
                summary.converged() ? "" : ", not converged");
  return text;
}

std::string default_cell(const MultiStartSummary& result, double optimum) {
  std::string text = cell(result.summary, optimum) + " from " + result.start;
  int all = 0;
  for (const StartTrial& trial : result.trials) all += trial.iterations;
  if (result.trials.size() > 1) text += " (" + std::to_string(all) + " in all)";
  return text;
}

void print_row(const std::string& modeling, const char* start, const Graph& graph, double optimum,
               const TypeRegistry& registry, bool with_default) {
  const std::string solver = registry.linear_solvers().front().type.name;
  std::printf("| %s | %s |", modeling.c_str(), start);
  OptimizerOptions options;
  options.max_iterations = 200;
  for (const char* algorithm : kAlgorithms) {
    Graph trial = graph;
    const Summary summary =
        optimize(trial, *registry.make_algorithm(algorithm), *registry.make_linear_solver(solver), options);
    std::printf(" %s |", cell(summary, optimum).c_str());
    std::fflush(stdout);
  }
  options.max_iterations = 500;
  for (const char* algorithm : kAlgorithms) {
    if (!with_default) break;
    Graph trial = graph;
    const auto result =
        optimize_from_best_start(trial, registry.starts(), *registry.make_algorithm(algorithm),
                                 *registry.make_linear_solver(solver), options);
    INFO(modeling << " " << start << " " << algorithm);
    CHECK(result.summary.final_chi2 == Approx(optimum).epsilon(1e-6));
    std::printf(" %s |", default_cell(result, optimum).c_str());
    std::fflush(stdout);
  }
  std::printf("\n");
}

}  // namespace

TEST_CASE("convergence table of the key workload", "[.table]") {
  const TypeRegistry registry = full_registry();
  for (const std::string modeling : {"G1", "G2", "G3"}) {
    const auto graph = key_workload(modeling, registry);
    if (!graph) return;
    const double optimum = modeling == "G2" ? 2910.5662 : 2910.5686;
    for (const Spoiling& how : kSpoilings) {
      const Graph spoilt = spoil(*graph, how, [&](VertexIndex v) { return graph->id(v) >= kFirstGnssNode; });
      print_row(modeling, how.name, spoilt, optimum, registry, true);
    }
    Graph anchored = *graph;
    anchored.set_values(registry.make_start("linear", *graph).values);
    print_row(modeling, "linear", anchored, optimum, registry, false);
  }
}
