#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <waymark/tools/report/drive/drive_figures.hpp>
#include <waymark/tools/report/drive/epoch_series.hpp>

namespace waymark::report {
namespace {

/// The stated and the actual errors of the epochs that have both.
struct StatedAndActual {
  drawing::Series points{/// (sigma, error), m
                         .name = "epoch",
                         .mark = drawing::Mark::points,
                         .look = drawing::Look::fused};
  std::vector<double> nees;  ///< ascending
};

StatedAndActual stated_errors(const ReportedDrive& drive) {
  StatedAndActual errors;
  for (const evaluation::EpochResult& epoch : drive.evaluation.epochs) {
    if (!epoch.position_covariance || !epoch.fused_offset_m || !std::isfinite(epoch.nees)) continue;
    errors.points.x.push_back(std::sqrt(epoch.position_covariance->trace() / 2));
    errors.points.y.push_back(epoch.fused_offset_m->norm());
    errors.points.time.push_back(drive.seconds(epoch.stamp));
    errors.nees.push_back(epoch.nees);
  }
  std::sort(errors.nees.begin(), errors.nees.end());
  return errors;
}

drawing::Figure sigma_figure(const drawing::Series& points) {
  drawing::Figure figure;
  figure.id = "sigma-error";
  figure.title = "Stated sigma against actual error";
  figure.description =
      "Stated sigma (root mean square of both axes) of each fused position and its distance from "
      "the truth. With consistent sigmas 39 % of the points are below the first line and "
      "95 % below the second.";
  figure.x = {.title = "stated sigma", .unit = "m", .low = 0};
  figure.y = {.title = "position error", .unit = "m", .low = 0};
  figure.width = 430;
  figure.height = 340;
  figure.series = {points};
  const double widest = 1.05 * *std::max_element(points.x.begin(), points.x.end());
  // The radius of the circle that holds 95 % of a plane Gaussian with sigma 1: the root of the
  // chi2 quantile.
  for (const double factor : {1.0, std::sqrt(evaluation::InnovationStatistics::kBound95)}) {
    figure.series.push_back({.name = fmt::format("{:.3g} sigma", factor),
                             .mark = drawing::Mark::line,
                             .look = factor == 1.0 ? drawing::Look::reference : drawing::Look::truth,
                             .x = {0, widest},
                             .y = {0, factor * widest}});
  }
  return figure;
}

drawing::Figure coverage_figure(const std::vector<double>& nees) {
  drawing::Figure figure;
  figure.id = "coverage";
  figure.title = "Coverage";
  figure.description =
      "Share of the epochs whose truth lies inside the stated region, over the share that the "
      "region should hold. Below the diagonal the stated covariances are too small, above "
      "it too large.";
  figure.x = {.title = "stated", .unit = "%", .low = 0, .high = 100};
  figure.y = {.title = "found", .unit = "%", .low = 0, .high = 100};
  figure.width = 430;
  figure.height = 340;
  drawing::Series found{
      .name = "fused", .mark = drawing::Mark::line, .look = drawing::Look::fused, .x = {0}, .y = {0}};
  for (std::size_t i = 0; i < nees.size(); ++i) {
    found.x.push_back(100 * (1 - std::exp(-0.5 * nees[i])));  // chi2 with two degrees of freedom
    found.y.push_back(100 * static_cast<double>(i + 1) / static_cast<double>(nees.size()));
  }
  found.x.push_back(100);
  found.y.push_back(100);
  figure.series = {std::move(found),
                   {.name = "consistent",
                    .mark = drawing::Mark::line,
                    .look = drawing::Look::reference,
                    .x = {0, 100},
                    .y = {0, 100}}};
  return figure;
}

drawing::Figure nees_figure(const ReportedDrive& drive) {
  drawing::Figure figure =
      time_figure(drive, "nees", "NEES over time",
                  "Squared error in units of the stated covariance: 2 on average and below 5.99 at "
                  "95 % of the epochs if the covariances are consistent.",
                  {.title = "NEES", .low = 0});
  figure.series.push_back(
      over_time(drive, "fused", drawing::Look::fused, [](const evaluation::EpochResult& e) {
        return std::isfinite(e.nees) ? std::optional(e.nees) : std::nullopt;
      }));
  figure.series.push_back(
      {.name = "95 % bound",
       .mark = drawing::Mark::line,
       .look = drawing::Look::reference,
       .x = {*figure.x.low, *figure.x.high},
       .y = {evaluation::InnovationStatistics::kBound95, evaluation::InnovationStatistics::kBound95}});
  return figure;
}

}  // namespace

std::vector<drawing::Figure> consistency_figures(const ReportedDrive& drive) {
  const StatedAndActual errors = stated_errors(drive);
  if (errors.nees.size() < 2) return {};
  return {sigma_figure(errors.points), coverage_figure(errors.nees), nees_figure(drive)};
}

}  // namespace waymark::report
