#include <cmath>

#include <waymark/tools/drawing/figure/bars.hpp>
#include <waymark/tools/report/consistency_bars.hpp>

namespace waymark::report {
std::vector<drawing::Figure> consistency_bars(const std::string& prefix,
                                              const std::vector<StatedErrors>& rows) {
  drawing::Figure nees{
      .id = prefix + "-nees",
      .title = "Mean NEES",
      .description =
          "Squared error in units of the stated covariance, averaged; 2 is consistent. With "
          "consistent covariances the means of 95 of 100 drives lie in the bracket. If a bar ends "
          "right of it, the stated errors are too small; left of it, too large.",
      .x = {.title = "mean NEES", .unit = "", .logarithmic = true},
      .y = {.title = "run", .unit = ""},
      .series = {}};
  drawing::Figure coverage{
      .id = prefix + "-coverage",
      .title = "Coverage of the stated 95 % regions",
      .description =
          "Share of the epochs whose stated region holds the truth. With consistent covariances the "
          "shares of 95 of 100 drives lie in the bracket.",
      .x = {.title = "epochs with the truth inside", .unit = "%", .low = 0},
      .y = {.title = "run", .unit = ""},
      .series = {}};
  drawing::Series nees_bars{.name = "mean NEES", .mark = drawing::Mark::bars, .look = drawing::Look::fused};
  drawing::Series coverage_bars{
      .name = "coverage", .mark = drawing::Mark::bars, .look = drawing::Look::fused};
  for (const StatedErrors& row : rows) {
    const evaluation::ConsistencyStatistics& s = row.statistics;
    if (!std::isfinite(s.nees_mean)) continue;
    const auto add = [&](drawing::Figure& figure, drawing::Series& bars, double value,
                         const evaluation::Interval95& consistent, double unit) {
      bars.y.push_back(static_cast<double>(figure.y.categories.size()));
      figure.y.categories.push_back(row.label);
      bars.x.push_back(unit * value);
      bars.low.push_back(unit * consistent.low);
      bars.high.push_back(unit * consistent.high);
    };
    add(nees, nees_bars, s.nees_mean, s.nees_mean_consistent, 1);
    add(coverage, coverage_bars, s.coverage, s.coverage_consistent, 100);
  }
  const std::size_t count = nees.y.categories.size();
  if (count == 0) return {};
  nees.series = {nees_bars, drawing::line_across("consistent: 2",
                                                 evaluation::ConsistencyStatistics::kExpectedMean, count)};
  coverage.series = {coverage_bars,
                     drawing::line_across("consistent: 95 %",
                                          100 * evaluation::ConsistencyStatistics::kExpectedCoverage, count)};
  drawing::fit_bars(nees);
  drawing::fit_bars(coverage);
  return {nees, coverage};
}

std::string consistency_verdict(const evaluation::ConsistencyStatistics& s) {
  if (!std::isfinite(s.nees_mean) || !std::isfinite(s.nees_mean_consistent.low)) return "-";
  if (s.nees_mean > s.nees_mean_consistent.high) return "too small";
  return s.nees_mean < s.nees_mean_consistent.low ? "too large" : "consistent";
}

}  // namespace waymark::report
