#include <waymark/solvers/optimize.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/core/optimize/named_start.hpp>
#include <waymark/solvers/register.hpp>
#include <waymark/types_se2/register.hpp>

namespace waymark {

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
  const auto solver = registry.make_linear_solver(
      fastest ? registry.linear_solvers().front().type.name : how.solver, how.solver_options);
  MultiStartSummary result = optimize_from(how.start, graph, registry, *algorithm, *solver, how.limits);
  result.summary.algorithm = how.algorithm;
  return result;
}

}  // namespace waymark
