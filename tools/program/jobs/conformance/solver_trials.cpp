#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/core/linear/block_cholesky.hpp>
#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/core/system/gauge.hpp>
#include <waymark/core/system/structure.hpp>
#include <waymark/tools/program/jobs/conformance/trials.hpp>
#include <waymark/types_se2/edge_se2.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::program {
namespace {

constexpr int kRing = 24;

/// A ring of poses with small errors in its edges, a fixed first pose, and a start that is off.
Graph ring() {
  Graph graph;
  const Pose2<double> step(1, 0, 2 * std::numbers::pi / kRing);
  Pose2<double> truth;
  for (int i = 0; i < kRing; ++i) {
    const double off = i == 0 ? 0 : 0.1 * std::sin(2.0 * i);
    graph.add_vertex<VertexSe2>(
        VertexId{i}, {truth.position[0] + off, truth.position[1] - off, truth.heading + 0.2 * off});
    truth = compose(truth, step);
  }
  graph.set_fixed(0, true);
  for (int i = 0; i < kRing; ++i) {
    const Eigen::Vector3d measured =
        step.vector() + 0.01 * Eigen::Vector3d(std::sin(i), std::cos(3 * i), 0.1);
    graph.add_edge(EdgeSe2{measured}, {i, (i + 1) % kRing}, Eigen::Vector3d(100, 100, 1000).asDiagonal());
  }
  return graph;
}

Summary minimise(Graph& graph, Algorithm& algorithm, LinearSolver& solver) {
  OptimizerOptions options;
  options.max_iterations = 500;
  options.decrement_tolerance = 1e-10;
  return optimize(graph, algorithm, solver, options);
}

double lowest_chi2(const TypeRegistry& registry) {
  Graph graph = ring();
  BlockCholesky solver;
  return minimise(graph, *registry.make_algorithm("dogleg"), solver).final_chi2;
}

void judge(const Summary& summary, double lowest, Trial& trial) {
  if (!summary.converged()) {
    trial.problems.push_back("does not converge on a ring of poses: " + summary.message);
  } else if (std::abs(summary.final_chi2 - lowest) > 1e-6 * lowest) {
    trial.problems.push_back(fmt::format("ends at chi2 {:.9g} on a ring of poses, the minimum is {:.9g}",
                                         summary.final_chi2, lowest));
  }
}

/// A matrix that has no factor must be told by the status, never by an exception or a solution.
void try_without_factor(LinearSolver& solver, Trial& trial) {
  const Graph graph = ring();
  Structure structure;
  structure.build(graph, find_gauge(graph).held);
  solver.analyze(structure.pattern());
  const auto count = static_cast<std::size_t>(structure.pattern().value_count());
  if (solver.factorize(std::vector<double>(count, -1.0)) == FactorStatus::ok)
    trial.problems.emplace_back("factorises a matrix with negative diagonal");
  if (solver.factorize(std::vector<double>(count, std::numeric_limits<double>::quiet_NaN())) ==
      FactorStatus::ok)
    trial.problems.emplace_back("factorises a matrix of NaN");
}

void try_start(const InitialValues& start, const Graph& graph, Trial& trial) {
  if (start.values.empty()) {
    trial.note = "gives no values for a ring of poses: " + start.note;
    return;
  }
  if (start.values.size() != graph.values().size()) {
    trial.problems.push_back(
        fmt::format("gives {} values, the graph has {}", start.values.size(), graph.values().size()));
    return;
  }
  Graph moved = graph;
  moved.set_values(start.values);
  if (!std::isfinite(moved.chi2())) trial.problems.emplace_back("gives values that are not finite");
  for (std::size_t i = 0; i < 3; ++i)
    if (start.values[i] != graph.values()[i]) trial.problems.emplace_back("moves a fixed vertex");
}

}  // namespace

void run_trial(Trial& trial, const std::function<void(Trial&)>& steps) {
  try {
    steps(trial);
  } catch (const std::exception& error) {
    trial.problems.emplace_back(error.what());
  } catch (...) {
    trial.problems.emplace_back("threw something that is no std::exception");
  }
}

std::vector<Trial> try_solvers(const TypeRegistry& registry, const Wanted& wanted) {
  std::vector<Trial> trials;
  const double lowest = lowest_chi2(registry);
  for (const auto& [type, origin] : registry.linear_solvers()) {
    if (!wanted(origin)) continue;
    run_trial(trials.emplace_back(Trial{"linear solver", type.name, origin, {}, {}}), [&](Trial& trial) {
      Graph graph = ring();
      judge(minimise(graph, *registry.make_algorithm("dogleg"), *registry.make_linear_solver(trial.name)),
            lowest, trial);
      try_without_factor(*registry.make_linear_solver(trial.name), trial);
    });
  }
  for (const auto& [type, origin] : registry.algorithms()) {
    if (!wanted(origin)) continue;
    run_trial(trials.emplace_back(Trial{"algorithm", type.name, origin, {}, {}}), [&](Trial& trial) {
      Graph graph = ring();
      BlockCholesky solver;
      judge(minimise(graph, *registry.make_algorithm(trial.name), solver), lowest, trial);
    });
  }
  for (const auto& [type, origin] : registry.starts()) {
    if (!wanted(origin)) continue;
    run_trial(trials.emplace_back(Trial{"initial guess", type.name, origin, {}, {}}), [&](Trial& trial) {
      const Graph graph = ring();
      try_start(registry.make_start(trial.name, graph), graph, trial);
    });
  }
  return trials;
}

}  // namespace waymark::program
