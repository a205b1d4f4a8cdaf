#include <waymark/core/optimize/named_start.hpp>

#include <algorithm>
#include <utility>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/suggest.hpp>

namespace waymark {

void check_start(std::string_view start, const TypeRegistry& registry, std::vector<std::string_view> names) {
  for (const auto& [type, origin] : registry.starts()) names.push_back(type.name);
  if (std::find(names.begin(), names.end(), start) != names.end()) return;
  throw UsageError("unknown initial guess '" + std::string(start) + "'" + suggestion(start, names));
}

MultiStartSummary optimize_from(std::string_view start, Graph& graph, const TypeRegistry& registry,
                                Algorithm& algorithm, LinearSolver& solver, const OptimizerOptions& options,
                                const Minimizer& search) {
  check_start(start, registry);
  if (start == kAutoStart) {
    if (!search) return optimize_from_best_start(graph, registry.starts(), algorithm, solver, options);
    start = kFileStart;
  }
  InitialValues made;
  if (start != kFileStart) {
    made = registry.make_start(start, graph);
    if (made.values.empty())
      throw InputError("initial guess " + std::string(start) + " cannot be made: " + made.note);
    graph.set_values(std::move(made.values));
  }
  MultiStartSummary result;
  result.summary =
      search ? search(graph, algorithm, solver, options) : optimize(graph, algorithm, solver, options);
  result.start = start;
  result.total_seconds = result.summary.total_seconds;
  if (made.apart > 0) result.summary.notes.push_back(apart_note(made.apart));
  return result;
}

std::string apart_note(std::size_t vertices) {
  return std::to_string(vertices) +
         " vertices are not joined to the first one by relative edges; each part begins at its own first "
         "vertex";
}

}  // namespace waymark
