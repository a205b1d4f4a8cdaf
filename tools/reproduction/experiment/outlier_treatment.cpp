#include <algorithm>
#include <cmath>

#include <waymark/core/base/error.hpp>
#include <waymark/core/robust/graduation.hpp>
#include <waymark/tools/drive/model/minimize.hpp>
#include <waymark/tools/reproduction/experiment/outlier_treatment.hpp>

namespace waymark::reproduction {

Graduated graduate_fixes(Graph& graph, const Setting& setting, const TypeRegistry& registry,
                         const std::atomic<bool>* cancel) {
  Graduated graduated;
  const Minimizer search = [&graduated](Graph& of, Algorithm& algorithm, LinearSolver& solver,
                                        const OptimizerOptions& rules) {
    GraduationOptions options;
    options.trusted = trust_each(
        [](const Graph& in, EdgePlace place) { return in.edge_type(place.batch).form != "position"; });
    options.optimizer = rules;
    GraduationResult found = graduate(of, algorithm, solver, options);
    of = without_edges(of, found.outliers);
    graduated.outliers = found.outliers.size();
    return std::move(found.summary);
  };
  const MultiStartSummary result =
      drive::minimize(graph, setting.fusion.minimization, registry, {.cancel = cancel}, search);
  graduated.ending = describe(result.summary);
  return graduated;
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
