#include <waymark/solvers/optimize.hpp>

#include <utility>

#include <waymark/core/base/error.hpp>
#include <waymark/solvers/register.hpp>
#include <waymark/types_se2/register.hpp>

namespace waymark {
namespace {

/// Optimises from the present values, or from those of one start.
MultiStartSummary optimize_from(const std::string& start, Graph& graph, const TypeRegistry& registry,
                                Algorithm& algorithm, LinearSolver& solver, const OptimizerOptions& limits) {
  InitialValues made;
  if (start != "file") {
    made = registry.make_start(start, graph);
    if (made.values.empty()) throw InputError("start " + start + " cannot be made: " + made.note);
    graph.set_values(std::move(made.values));
  }
  MultiStartSummary result;
  result.summary = optimize(graph, algorithm, solver, limits);
  result.start = start;
  result.total_seconds = result.summary.total_seconds;
  if (made.apart > 0) {
    result.summary.notes.push_back(std::to_string(made.apart) +
                                   " vertices are not joined to the first one by relative edges; each part "
                                   "begins at its own first vertex");
  }
  return result;
}

}  // namespace

MultiStartSummary optimize(Graph& graph, const Optimization& how) {
  TypeRegistry registry;
  register_se2_types(registry);
  solvers::register_solvers(registry);
  return optimize(graph, registry, how);
}

MultiStartSummary optimize(Graph& graph, const TypeRegistry& registry, const Optimization& how) {
  const bool fastest = how.solver == "auto";
  if (fastest && registry.linear_solvers().empty())
    throw UsageError("optimize: no linear solver is registered");
  const auto algorithm = registry.make_algorithm(how.algorithm, how.algorithm_options);
  const auto solver =
      registry.make_linear_solver(fastest ? registry.linear_solvers().front().type.name : how.solver);
  MultiStartSummary result =
      how.start == "auto"
          ? optimize_from_best_start(graph, registry.starts(), *algorithm, *solver, how.limits)
          : optimize_from(how.start, graph, registry, *algorithm, *solver, how.limits);
  result.summary.algorithm = how.algorithm;
  return result;
}

}  // namespace waymark
