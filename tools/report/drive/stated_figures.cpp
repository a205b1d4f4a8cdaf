#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <waymark/tools/drawing/figure/look.hpp>
#include <waymark/tools/evaluation/weak_stretches.hpp>
#include <waymark/tools/report/drive/drive_figures.hpp>
#include <waymark/tools/report/drive/epoch_series.hpp>

namespace waymark::report {
namespace {

constexpr double kToDegrees = 180 / std::numbers::pi;

/// Keeps a figure that has a line with at least two points.
void keep_if_drawn(drawing::Figure figure, std::vector<drawing::Figure>& figures) {
  const bool drawn =
      std::any_of(figure.series.begin(), figure.series.end(), [](const drawing::Series& series) {
        return series.mark == drawing::Mark::line && !series.time.empty() && series.x.size() > 1;
      });
  if (drawn) figures.push_back(std::move(figure));
}

drawing::Series level(const drawing::Figure& figure, const std::string& name, double value) {
  return {.name = name,
          .mark = drawing::Mark::line,
          .look = drawing::Look::reference,
          .x = {*figure.x.low, *figure.x.high},
          .y = {value, value}};
}

}  // namespace

std::vector<drawing::Figure> sigmas_over_time(const ReportedDrive& drive) {
  std::vector<drawing::Figure> figures;
  drawing::Figure position =
      time_figure(drive, "sigma", "Stated sigma of the position",
                  "Root mean square of both axes, from the marginal covariances. It says how well the "
                  "measurements determine the position, if their noise is as stated.",
                  {.title = "position sigma", .unit = "m", .low = 0});
  position.series.push_back(over_time(drive, "fused", drawing::Look::fused,
                                      [](const evaluation::EpochResult& e) { return e.sigma_m(); }));
  position.series.push_back(over_time(drive, "stated by the receiver", drawing::Look::raw,
                                      [](const evaluation::EpochResult& e) -> std::optional<double> {
                                        const double sigma = std::sqrt(0.5 * e.fix_sigma_m.squaredNorm());
                                        return std::isfinite(sigma) ? std::optional(sigma) : std::nullopt;
                                      }));
  if (position.series[position.series.size() - 2].x.size() > 1) keep_if_drawn(std::move(position), figures);
  drawing::Figure heading = time_figure(drive, "sigma-heading", "Stated sigma of the heading",
                                        "From the marginal covariances of the fused poses.",
                                        {.title = "heading sigma", .unit = "deg", .low = 0});
  heading.series.push_back(
      over_time(drive, "fused", drawing::Look::fused, [](const evaluation::EpochResult& e) {
        return e.heading_sigma_rad ? std::optional(*e.heading_sigma_rad * kToDegrees) : std::nullopt;
      }));
  keep_if_drawn(std::move(heading), figures);
  drawing::Figure nis = time_figure(
      drive, "nis", "NIS over time",
      "Squared distance of each fix from the fused antenna, in units of the covariance that it should have. "
      "2 on average and below 5.99 at 95 % of the fixes if the stated accuracies are right.",
      {.title = "NIS", .low = 0});
  nis.series.push_back(over_time(drive, "fix", drawing::Look::raw, [](const evaluation::EpochResult& e) {
    return std::isfinite(e.nu) ? std::optional(e.nu) : std::nullopt;
  }));
  nis.series.push_back(level(nis, "95 % bound", evaluation::InnovationStatistics::kBound95));
  keep_if_drawn(std::move(nis), figures);
  return figures;
}

std::vector<drawing::Figure> receiver_figures(const ReportedDrive& drive) {
  std::vector<drawing::Figure> figures;
  drawing::Figure satellites =
      time_figure(drive, "satellites", "Satellites", "Used in each fix.", {.title = "satellites", .low = 0});
  satellites.series.push_back(
      over_time(drive, "satellites", drawing::Look::raw, [](const evaluation::EpochResult& e) {
        return e.told.satellites >= 0 ? std::optional<double>(e.told.satellites) : std::nullopt;
      }));
  keep_if_drawn(std::move(satellites), figures);
  drawing::Figure hdop = time_figure(
      drive, "hdop", "HDOP",
      "Horizontal dilution of precision: how much the geometry of the satellites enlarges errors.",
      {.title = "HDOP", .low = 0});
  hdop.series.push_back(over_time(drive, "HDOP", drawing::Look::raw, [](const evaluation::EpochResult& e) {
    return e.told.hdop > 0 ? std::optional(e.told.hdop) : std::nullopt;
  }));
  keep_if_drawn(std::move(hdop), figures);
  if (drive.evaluation.by_quality.empty()) return figures;
  drawing::Figure quality = time_figure(drive, "quality", "Quality of the fixes",
                                        "The stated sigma of each fix, by the quality of its solution.",
                                        {.title = "stated sigma", .unit = "m", .logarithmic = true});
  std::size_t index = 0;
  for (const evaluation::QualityMetrics& of : drive.evaluation.by_quality) {
    drawing::Series points =
        over_time(drive, std::string(to_string(of.quality)), drawing::look_of_system(index++),
                  [&](const evaluation::EpochResult& e) -> std::optional<double> {
                    const double sigma = std::sqrt(0.5 * e.fix_sigma_m.squaredNorm());
                    return e.told.quality == of.quality && sigma > 0 ? std::optional(sigma) : std::nullopt;
                  });
    points.mark = drawing::Mark::points;
    quality.series.push_back(std::move(points));
  }
  figures.push_back(std::move(quality));
  return figures;
}

drawing::Figure fix_residuals_over_time(const ReportedDrive& drive) {
  drawing::Figure figure = time_figure(
      drive, "fix-residuals", "Fix minus fused position",
      "Distance of each raw fix from the fused antenna at the moment when the fix was measured: an "
      "estimated delay is applied. This is no error: fixes that pull the poses look better than "
      "they are.",
      {.title = "fix - fused", .unit = "m", .low = 0});
  figure.series.push_back(over_time(drive, "fix - fused", drawing::Look::raw,
                                    [](const evaluation::EpochResult& e) -> std::optional<double> {
                                      return e.fix_residual_m ? std::optional(e.fix_residual_m->norm())
                                                              : std::nullopt;
                                    }));
  if (!drive.evaluation.held_out) return figure;
  figure.description += " The kept out fixes are compared with a second fusion, which does not know them.";
  drawing::Series kept_out{
      .name = "kept out", .mark = drawing::Mark::points, .look = drawing::Look::withheld};
  const evaluation::HeldOut& held = *drive.evaluation.held_out;
  for (std::size_t i = 0; i < held.stamps.size(); ++i) {
    kept_out.x.push_back(drive.seconds(held.stamps[i]));
    kept_out.y.push_back(held.errors_m[i]);
  }
  kept_out.time = kept_out.x;
  figure.series.push_back(std::move(kept_out));
  return figure;
}

text::Table weak_table(const ReportedDrive& drive) {
  const bool against_truth = drive.evaluation.truth.has_value();
  text::Table table{
      .title = "Where the result is weakest",
      .columns = {"from [s]", "to [s]", against_truth ? "largest error [m]" : "largest sigma [m]", "at [s]",
                  "mean [m]", "reason"}};
  const auto seconds = [&](Stamp stamp) { return fmt::format("{:.1f}", drive.seconds(stamp)); };
  for (const evaluation::WeakStretch& weak :
       evaluation::weak_stretches(drive.evaluation.epochs, against_truth)) {
    table.rows.push_back(
        {seconds(weak.begin), seconds(weak.end), fmt::format("{:.3f}", weak.peak_m), seconds(weak.peak),
         fmt::format("{:.3f}", weak.mean_m),
         weak.reasons.empty() ? "the fixes tell none" : fmt::format("{}", fmt::join(weak.reasons, ", "))});
  }
  table.notes = {"A stretch reaches as far as the value stays above half of its peak and above 1.2 medians."};
  return table;
}

}  // namespace waymark::report
