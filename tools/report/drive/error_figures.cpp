#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <waymark/tools/report/drive/drive_figures.hpp>
#include <waymark/tools/report/drive/epoch_series.hpp>

namespace waymark::report {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

std::optional<double> length(const std::optional<Eigen::Vector2d>& offset) {
  return offset ? std::optional(offset->norm()) : std::nullopt;
}

/// Keeps the figure only if it shows something.
void add_if_seen(drawing::Figure figure, std::vector<drawing::Figure>& figures) {
  const bool seen =
      std::any_of(figure.series.begin(), figure.series.end(), [](const drawing::Series& series) {
        return series.mark == drawing::Mark::line && series.x.size() > 1;
      });
  if (seen) figures.push_back(std::move(figure));
}

std::optional<double> component(const evaluation::EpochResult& epoch, Offset offset, bool along) {
  if (!(epoch.*offset) || !epoch.direction_rad) return std::nullopt;
  const evaluation::TrackOffset split = evaluation::track_offset(*(epoch.*offset), *epoch.direction_rad);
  return along ? split.along_m : split.cross_m;
}

drawing::Figure track_figure(const ReportedDrive& drive, bool along) {
  drawing::Figure figure = time_figure(
      drive, along ? "error-along" : "error-across", along ? "Error along track" : "Error across track",
      along ? "Positive: ahead of the truth, in the truth's direction of travel."
            : "Positive: to the left of the truth's direction of travel.",
      {.title = along ? "along track" : "across track", .unit = "m"});
  for (const auto& [name, look, offset] :
       {std::tuple{"raw GNSS", drawing::Look::raw, Offset(&evaluation::EpochResult::gnss_offset_m)},
        std::tuple{"fused", drawing::Look::fused, Offset(&evaluation::EpochResult::fused_offset_m)}}) {
    const Offset which = offset;
    figure.series.push_back(over_time(drive, name, look, [&](const evaluation::EpochResult& epoch) {
      return component(epoch, which, along);
    }));
  }
  return figure;
}

/// Returns the band of two stated sigmas about zero. It holds 95 % of the errors of one axis if the
/// covariances are consistent.
drawing::Series two_sigmas(
    const ReportedDrive& drive,
    const std::function<std::optional<double>(const evaluation::EpochResult&)>& sigma) {
  drawing::Series band{.name = "2 sigma", .mark = drawing::Mark::band, .look = drawing::Look::reference};
  for (const evaluation::EpochResult& epoch : drive.evaluation.epochs) {
    const std::optional<double> value = sigma(epoch);
    if (!value || !std::isfinite(*value)) continue;
    band.x.push_back(drive.seconds(epoch.stamp));
    band.low.push_back(-2 * *value);
    band.high.push_back(2 * *value);
  }
  return band;
}

drawing::Figure axis_figure(const ReportedDrive& drive, Eigen::Index axis) {
  const std::string name = axis == 0 ? "east" : "north";
  drawing::Figure figure =
      time_figure(drive, "error-" + name, "Error to the " + name,
                  "Grid " + name +
                      ". The band is two stated sigmas of the fused position: 95 % of the fused errors "
                      "lie inside if the covariances are consistent.",
                  {.title = "error " + name, .unit = "m"});
  drawing::Series band = two_sigmas(drive, [axis](const evaluation::EpochResult& e) {
    return e.position_covariance ? std::optional(std::sqrt((*e.position_covariance)(axis, axis)))
                                 : std::nullopt;
  });
  if (!band.x.empty()) figure.series.push_back(std::move(band));
  for (const auto& [label, look, offset] :
       {std::tuple{"raw GNSS", drawing::Look::raw, Offset(&evaluation::EpochResult::gnss_offset_m)},
        std::tuple{"fused", drawing::Look::fused, Offset(&evaluation::EpochResult::fused_offset_m)}}) {
    const Offset which = offset;
    figure.series.push_back(over_time(drive, label, look, [which, axis](const evaluation::EpochResult& e) {
      return e.*which ? std::optional((*(e.*which))[axis]) : std::nullopt;
    }));
  }
  return figure;
}

drawing::Series distribution(const ReportedDrive& drive, Offset which, const std::string& name,
                             drawing::Look look) {
  std::vector<double> errors;
  for (const Eigen::Vector2d& offset : offsets(drive, which)) errors.push_back(offset.norm());
  std::sort(errors.begin(), errors.end());
  drawing::Series series{.name = name, .mark = drawing::Mark::line, .look = look};
  for (std::size_t i = 0; i < errors.size(); ++i) {
    series.x.push_back(errors[i]);
    series.y.push_back(100 * static_cast<double>(i + 1) / static_cast<double>(errors.size()));
  }
  return series;
}

/// If the largest raw error exceeds the largest fused error by this factor, the fused line looks
/// flat. An axis in powers of ten then shows both.
constexpr double kTooFarApart = 8;
constexpr double kLeastError = 0.01;  // m, the smallest begin of such an axis

void fit_error_axis(drawing::Figure& figure, const evaluation::TruthEvaluation& truth) {
  const double fused = truth.fused.position.max_m;
  if (!(truth.gnss.position.max_m > kTooFarApart * fused) || !(fused > kLeastError)) return;
  double smallest = fused;
  for (const drawing::Series& series : figure.series) {
    for (const double error : series.y) smallest = std::min(smallest, error);
  }
  figure.y.logarithmic = true;
  figure.y.low = std::max(0.9 * smallest, kLeastError);
}

}  // namespace

std::vector<drawing::Figure> errors_over_time(const ReportedDrive& drive) {
  std::vector<drawing::Figure> figures;
  drawing::Figure position =
      time_figure(drive, "error-position", "Position error",
                  "Distance from the truth at the stamps of the fixes. Drag to move, click and "
                  "turn the wheel to zoom: all figures over time follow.",
                  {.title = "position error", .unit = "m", .low = 0});
  position.series.push_back(
      over_time(drive, "raw GNSS", drawing::Look::raw,
                [](const evaluation::EpochResult& e) { return length(e.gnss_offset_m); }));
  position.series.push_back(
      over_time(drive, "fused", drawing::Look::fused,
                [](const evaluation::EpochResult& e) { return length(e.fused_offset_m); }));
  if (drive.evaluation.truth) fit_error_axis(position, *drive.evaluation.truth);
  add_if_seen(std::move(position), figures);
  add_if_seen(axis_figure(drive, 0), figures);
  add_if_seen(axis_figure(drive, 1), figures);
  add_if_seen(track_figure(drive, true), figures);
  add_if_seen(track_figure(drive, false), figures);
  drawing::Figure turned = time_figure(drive, "error-heading", "Heading error",
                                       "Fused minus true heading; positive is turned too far to the left. "
                                       "The band is two stated sigmas.",
                                       {.title = "heading error", .unit = "deg"});
  drawing::Series band = two_sigmas(drive, [](const evaluation::EpochResult& e) {
    return e.heading_sigma_rad ? std::optional(*e.heading_sigma_rad * kDegrees) : std::nullopt;
  });
  if (!band.x.empty()) turned.series.push_back(std::move(band));
  turned.series.push_back(
      over_time(drive, "fused", drawing::Look::fused, [](const evaluation::EpochResult& e) {
        return e.heading_error_rad ? std::optional(*e.heading_error_rad * kDegrees) : std::nullopt;
      }));
  add_if_seen(std::move(turned), figures);
  drawing::Figure height =
      time_figure(drive, "error-height", "Height error",
                  "The height state of the graph minus the height of the truth, above the ellipsoid.",
                  {.title = "height error", .unit = "m"});
  height.series.push_back(over_time(drive, "fused", drawing::Look::fused,
                                    [](const evaluation::EpochResult& e) { return e.height_error_m; }));
  add_if_seen(std::move(height), figures);
  drawing::Figure speed =
      time_figure(drive, "speed", "Speed", "Speed of the fused body point; negative in reverse.",
                  {.title = "speed", .unit = "m/s"});
  speed.series.push_back(over_time(drive, "fused", drawing::Look::fused,
                                   [](const evaluation::EpochResult& e) { return e.speed_mps; }));
  add_if_seen(std::move(speed), figures);
  return figures;
}

drawing::Figure error_distribution(const ReportedDrive& drive) {
  drawing::Figure figure;
  figure.id = "error-distribution";
  figure.title = "Distribution of the position error";
  figure.x = {.title = "position error", .unit = "m", .low = 0};
  figure.y = {.title = "epochs with a smaller error", .unit = "%", .low = 0, .high = 100};
  figure.motion = drawing::Motion::x;
  figure.series = {
      distribution(drive, &evaluation::EpochResult::gnss_offset_m, "raw GNSS", drawing::Look::raw),
      distribution(drive, &evaluation::EpochResult::fused_offset_m, "fused", drawing::Look::fused)};
  const double widest = std::max(figure.series[0].x.empty() ? 0 : figure.series[0].x.back(),
                                 figure.series[1].x.empty() ? 0 : figure.series[1].x.back());
  for (const double level : {50.0, 95.0}) {
    figure.series.push_back({.name = fmt::format("{:g} %", level),
                             .mark = drawing::Mark::line,
                             .look = drawing::Look::reference,
                             .x = {0, widest},
                             .y = {level, level}});
  }
  const evaluation::TruthEvaluation& truth = *drive.evaluation.truth;
  figure.description = fmt::format(
      "CEP50 {:.3f} m raw, {:.3f} m fused; CEP95 {:.3f} m raw, {:.3f} m fused. The dashed lines "
      "meet the curves there.",
      truth.gnss.position.cep50_m, truth.fused.position.cep50_m, truth.gnss.position.cep95_m,
      truth.fused.position.cep95_m);
  return figure;
}

drawing::Figure autocorrelation_figure(const ReportedDrive& drive) {
  drawing::Figure figure;
  figure.id = "autocorrelation";
  figure.title = "Autocorrelation of the error";
  figure.description =
      "Autocorrelation of the errors about their mean, both axes together. 1: the error has not "
      "changed after this time. 0: it is independent of the earlier one. If errors last, many fixes "
      "hold the information of few; a graph with white noise ignores that.";
  figure.x = {.title = "lag", .unit = "s", .low = 0};
  figure.y = {.title = "autocorrelation", .unit = "", .high = 1};
  figure.motion = drawing::Motion::x;
  const auto& epochs = drive.evaluation.epochs;
  const double duration = epochs.empty() ? 0 : seconds_between(epochs.front().stamp, epochs.back().stamp);
  const double longest = std::clamp(duration / 4, 1.0, 120.0);
  std::vector<double> lags;
  for (double lag = 1; lag <= longest; lag += longest > 60 ? 2 : 1) lags.push_back(lag);
  for (const auto& [name, look, offset] :
       {std::tuple{"raw GNSS", drawing::Look::raw, Offset(&evaluation::EpochResult::gnss_offset_m)},
        std::tuple{"fused", drawing::Look::fused, Offset(&evaluation::EpochResult::fused_offset_m)}}) {
    std::vector<Stamp> stamps;
    for (const evaluation::EpochResult& epoch : epochs) {
      if (epoch.*offset) stamps.push_back(epoch.stamp);
    }
    drawing::Series series{.name = name, .mark = drawing::Mark::line, .look = look};
    series.x = lags;
    series.y = evaluation::error_autocorrelation(stamps, offsets(drive, offset), lags);
    series.x.insert(series.x.begin(), 0);
    series.y.insert(series.y.begin(), 1);
    figure.series.push_back(std::move(series));
  }
  figure.series.push_back({.name = "1/e",
                           .mark = drawing::Mark::line,
                           .look = drawing::Look::reference,
                           .x = {0, longest},
                           .y = {std::exp(-1.0), std::exp(-1.0)}});
  return figure;
}

}  // namespace waymark::report
