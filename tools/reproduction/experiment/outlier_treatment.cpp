#include <algorithm>
#include <cmath>

#include <waymark/core/base/error.hpp>
#include <waymark/core/robust/graduation.hpp>
#include <waymark/tools/reproduction/experiment/outlier_treatment.hpp>

namespace waymark::reproduction {

Graduated graduate_fixes(Graph& graph, const Minimization& how, const TypeRegistry& registry,
                         const std::atomic<bool>* cancel) {
  const auto algorithm = registry.make_algorithm(how.algorithm, how.options);
  const auto solver = registry.make_linear_solver(registry.linear_solvers().front().type.name);
  GraduationOptions options;
  options.trusted = [](const Graph& of, EdgePlace place) {
    return of.edge_type(place.batch).form != "position";
  };
  options.optimizer.max_iterations = how.max_iterations;
  options.optimizer.decrement_tolerance = how.tolerance;
  options.optimizer.cancel = cancel;
  const GraduationResult found = graduate(graph, *algorithm, *solver, options);
  graph = without_edges(graph, found.outliers);
  return {describe(found.summary), found.outliers.size()};
}

std::vector<Fix> inflate_fixes(std::span<const Fix> fixes,
                               std::span<const evaluation::EpochResult> residuals) {
  if (fixes.size() != residuals.size()) throw UsageError("inflate_fixes: one residual per fix is needed");
  std::vector<Fix> inflated(fixes.begin(), fixes.end());
  std::size_t begin = 0;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    while (seconds_between(fixes[begin].stamp, fixes[i].stamp) > kInflationWindow) ++begin;
    double sum = 0;
    double count = 0;
    for (std::size_t j = begin; j < fixes.size(); ++j) {
      if (seconds_between(fixes[i].stamp, fixes[j].stamp) > kInflationWindow) break;
      const bool counts = residuals[j].status == FixStatus::accepted && fixes[j].source == fixes[i].source;
      if (!counts || !std::isfinite(residuals[j].nu)) continue;
      sum += residuals[j].nu;
      ++count;
    }
    if (count > 0)
      inflated[i].covariance *= std::max(1.0, sum / count / evaluation::InnovationStatistics::kExpectedMean);
  }
  return inflated;
}

}  // namespace waymark::reproduction
