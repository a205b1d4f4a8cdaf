#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include <waymark/tools/report/drive_figures.hpp>

namespace waymark {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

using Offset = std::optional<Eigen::Vector2d> EpochResult::*;

/// One system's value at every epoch that has one.
template <typename Value>
Series over_time(const ReportedDrive& drive, const std::string& name, Look look, Value value) {
  Series series{.name = name, .mark = Mark::line, .look = look};
  for (const EpochResult& epoch : drive.evaluation.epochs) {
    const std::optional<double> y = value(epoch);
    if (!y) continue;
    const double seconds = drive.seconds(epoch.stamp);
    series.x.push_back(seconds);
    series.y.push_back(*y);
    series.time.push_back(seconds);
  }
  return series;
}

std::optional<double> length(const std::optional<Eigen::Vector2d>& offset) {
  return offset ? std::optional(offset->norm()) : std::nullopt;
}

/// Runs of rejected or withheld fixes, from the first to the last of each.
Series spans(const ReportedDrive& drive, FixStatus status, const std::string& name, Look look) {
  Series series{.name = name, .mark = Mark::spans, .look = look};
  bool goes_on = false;
  for (const EpochResult& epoch : drive.evaluation.epochs) {
    const double seconds = drive.seconds(epoch.stamp);
    if (epoch.status != status) {
      goes_on = false;
    } else if (goes_on) {
      series.high.back() = seconds;
    } else {
      series.low.push_back(seconds);
      series.high.push_back(seconds);
      goes_on = true;
    }
  }
  return series;
}

Figure time_figure(const ReportedDrive& drive, const std::string& id, const std::string& title,
                   const std::string& description, const Axis& y) {
  Figure figure;
  figure.id = id;
  figure.title = title;
  figure.description = description;
  figure.x = {.title = "time since start", .unit = "s"};
  figure.y = y;
  figure.motion = Motion::x;
  figure.link = "time";
  figure.height = 240;
  for (Series& series : std::vector{spans(drive, FixStatus::rejected, "fixes rejected", Look::rejected),
                                    spans(drive, FixStatus::withheld, "fixes withheld", Look::withheld)}) {
    if (!series.low.empty()) figure.series.push_back(std::move(series));
  }
  const Range extent = epochs_extent(drive);
  figure.x.low = extent.low;
  figure.x.high = extent.high;
  return figure;
}

/// Keeps the figure only where there is something to be seen.
void add_if_seen(Figure figure, std::vector<Figure>& figures) {
  const bool seen = std::any_of(figure.series.begin(), figure.series.end(), [](const Series& series) {
    return series.mark == Mark::line && series.x.size() > 1;
  });
  if (seen) figures.push_back(std::move(figure));
}

std::optional<double> component(const EpochResult& epoch, Offset offset, bool along) {
  if (!(epoch.*offset) || !epoch.direction_rad) return std::nullopt;
  const TrackOffset split = track_offset(*(epoch.*offset), *epoch.direction_rad);
  return along ? split.along_m : split.cross_m;
}

Figure track_figure(const ReportedDrive& drive, bool along) {
  Figure figure = time_figure(drive, along ? "error-along" : "error-across",
                              along ? "Error along track" : "Error across track",
                              along ? "Positive: ahead of the truth, in the truth's direction of travel."
                                    : "Positive: to the left of the truth's direction of travel.",
                              {.title = along ? "along track" : "across track", .unit = "m"});
  for (const auto& [name, look, offset] :
       {std::tuple{"raw GNSS", Look::raw, Offset(&EpochResult::gnss_offset_m)},
        std::tuple{"fused", Look::fused, Offset(&EpochResult::fused_offset_m)}}) {
    const Offset which = offset;
    figure.series.push_back(over_time(
        drive, name, look, [&](const EpochResult& epoch) { return component(epoch, which, along); }));
  }
  return figure;
}

std::vector<Eigen::Vector2d> offsets(const ReportedDrive& drive, Offset which) {
  std::vector<Eigen::Vector2d> result;
  for (const EpochResult& epoch : drive.evaluation.epochs) {
    if (epoch.*which) result.push_back(*(epoch.*which));
  }
  return result;
}

Series ellipse(const Eigen::Vector2d& mean, const Eigen::Matrix2d& covariance, Look look) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(covariance);
  const Eigen::Matrix2d root =
      axes.eigenvectors() * axes.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal().toDenseMatrix();
  Series series{.name = "1-sigma ellipse", .mark = Mark::line, .look = look};
  for (int degrees = 0; degrees <= 360; degrees += 5) {
    const double angle = degrees / kDegrees;
    const Eigen::Vector2d point = mean + root * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    series.x.push_back(point.x());
    series.y.push_back(point.y());
  }
  return series;
}

Figure tile(const ReportedDrive& drive, Offset which, const std::string& name, Look look, double half_m) {
  Figure figure;
  figure.id = "tile-" + std::string(look == Look::raw ? "raw" : "fused");
  figure.title = "Error tile, " + name;
  figure.x = {.title = "east error", .unit = "m", .low = -half_m, .high = half_m};
  figure.y = {.title = "north error", .unit = "m", .low = -half_m, .high = half_m};
  figure.motion = Motion::map;
  figure.width = 430;
  figure.height = 440;
  Series errors{.name = "error", .mark = Mark::points, .look = look};
  for (const EpochResult& epoch : drive.evaluation.epochs) {
    if (!(epoch.*which)) continue;
    errors.x.push_back((epoch.*which)->x());
    errors.y.push_back((epoch.*which)->y());
    errors.time.push_back(drive.seconds(epoch.stamp));
  }
  const std::vector<Eigen::Vector2d> all = offsets(drive, which);
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& offset : all) mean += offset / static_cast<double>(all.size());
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& offset : all)
    covariance +=
        (offset - mean) * (offset - mean).transpose() / std::max(static_cast<double>(all.size()) - 1, 1.0);
  const auto outside = std::count_if(all.begin(), all.end(), [&](const Eigen::Vector2d& offset) {
    return offset.cwiseAbs().maxCoeff() > half_m;
  });
  figure.description = fmt::format(
      "{} epochs, {} of them outside the tile of {:g} x {:g} m; mean ({:.2f}, {:.2f}) m, |mean| = Acc = "
      "{:.3f} m; the ellipse has the errors' covariance about their mean, sigma east {:.2f} m, north {:.2f} "
      "m.",
      all.size(), outside, 2 * half_m, 2 * half_m, mean.x(), mean.y(), mean.norm(),
      std::sqrt(covariance(0, 0)), std::sqrt(covariance(1, 1)));
  Series centre{.name = "mean", .mark = Mark::points, .look = Look::truth, .x = {mean.x()}, .y = {mean.y()}};
  Series origin{.name = "truth", .mark = Mark::points, .look = Look::reference, .x = {0}, .y = {0}};
  figure.series = {std::move(errors), ellipse(mean, covariance, Look::truth), std::move(centre),
                   std::move(origin)};
  if (half_m > 1) {
    figure.series.push_back({.name = "2 x 2 m",
                             .mark = Mark::line,
                             .look = Look::reference,
                             .x = {-1, 1, 1, -1, -1},
                             .y = {-1, -1, 1, 1, -1}});
  }
  return figure;
}

/// The paper's metre to each side where it holds half of the fused errors, their ellipse and the mean of both
/// systems, else the next round number that does.
double half_width(const ReportedDrive& drive) {
  std::vector<double> largest;
  for (const Eigen::Vector2d& offset : offsets(drive, &EpochResult::fused_offset_m))
    largest.push_back(offset.cwiseAbs().maxCoeff());
  std::sort(largest.begin(), largest.end());
  double needed = nearest_rank_quantile(largest, 0.5);
  const TruthEvaluation& truth = *drive.evaluation.truth;
  needed = std::max(needed, 1.05 * truth.gnss.position.mean_m.cwiseAbs().maxCoeff());
  const double spread =
      std::isfinite(truth.fused.position.precision_m) ? truth.fused.position.precision_m : 0;
  needed = std::max(needed, truth.fused.position.mean_m.cwiseAbs().maxCoeff() + spread);
  for (const double half : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0}) {
    if (!(needed > half)) return half;
  }
  return 1000;
}

Series distribution(const ReportedDrive& drive, Offset which, const std::string& name, Look look) {
  std::vector<double> errors;
  for (const Eigen::Vector2d& offset : offsets(drive, which)) errors.push_back(offset.norm());
  std::sort(errors.begin(), errors.end());
  Series series{.name = name, .mark = Mark::line, .look = look};
  for (std::size_t i = 0; i < errors.size(); ++i) {
    series.x.push_back(errors[i]);
    series.y.push_back(100 * static_cast<double>(i + 1) / static_cast<double>(errors.size()));
  }
  return series;
}

}  // namespace

Range epochs_extent(const ReportedDrive& drive) {
  const auto& epochs = drive.evaluation.epochs;
  if (epochs.empty()) return {0, 1};
  const double first = drive.seconds(epochs.front().stamp);
  return {first, std::max(drive.seconds(epochs.back().stamp), first + 1e-3)};
}

FigureRow error_tiles(const ReportedDrive& drive) {
  const double half_m = half_width(drive);
  return {{tile(drive, &EpochResult::gnss_offset_m, "raw GNSS", Look::raw, half_m),
           tile(drive, &EpochResult::fused_offset_m, "fused", Look::fused, half_m)}};
}

namespace {

/// Beyond this ratio of the largest raw to the largest fused error the latter is a flat line; an axis in
/// powers of ten shows both.
constexpr double kTooFarApart = 8;
constexpr double kLeastError = 0.01;  // m, where such an axis begins at the earliest

void fit_error_axis(Figure& figure, const TruthEvaluation& truth) {
  const double fused = truth.fused.position.max_m;
  if (!(truth.gnss.position.max_m > kTooFarApart * fused) || !(fused > kLeastError)) return;
  double smallest = fused;
  for (const Series& series : figure.series) {
    for (const double error : series.y) smallest = std::min(smallest, error);
  }
  figure.y.logarithmic = true;
  figure.y.low = std::max(0.9 * smallest, kLeastError);
}

}  // namespace

std::vector<Figure> errors_over_time(const ReportedDrive& drive) {
  std::vector<Figure> figures;
  Figure position = time_figure(drive, "error-position", "Position error",
                                "Distance from the truth at the stamps of the fixes. Drag to move, click and "
                                "turn the wheel to zoom: all figures over time follow.",
                                {.title = "position error", .unit = "m", .low = 0});
  position.series.push_back(
      over_time(drive, "raw GNSS", Look::raw, [](const EpochResult& e) { return length(e.gnss_offset_m); }));
  position.series.push_back(
      over_time(drive, "fused", Look::fused, [](const EpochResult& e) { return length(e.fused_offset_m); }));
  if (drive.evaluation.truth) fit_error_axis(position, *drive.evaluation.truth);
  add_if_seen(std::move(position), figures);
  add_if_seen(track_figure(drive, true), figures);
  add_if_seen(track_figure(drive, false), figures);
  Figure turned = time_figure(drive, "error-heading", "Heading error",
                              "Fused minus true heading; positive is turned too far to the left.",
                              {.title = "heading error", .unit = "deg"});
  turned.series.push_back(over_time(drive, "fused", Look::fused, [](const EpochResult& e) {
    return e.heading_error_rad ? std::optional(*e.heading_error_rad * kDegrees) : std::nullopt;
  }));
  add_if_seen(std::move(turned), figures);
  Figure speed = time_figure(drive, "speed", "Speed", "Of the fused body point; negative in reverse.",
                             {.title = "speed", .unit = "m/s"});
  speed.series.push_back(
      over_time(drive, "fused", Look::fused, [](const EpochResult& e) { return e.speed_mps; }));
  add_if_seen(std::move(speed), figures);
  return figures;
}

Figure fix_residuals_over_time(const ReportedDrive& drive) {
  Figure figure =
      time_figure(drive, "fix-residuals", "Fix minus fused position",
                  "How far each raw fix lies from the fused antenna's place, whether it was used or not. Not "
                  "an error: where fixes pull the poses they look better than they are.",
                  {.title = "fix - fused", .unit = "m", .low = 0});
  const std::vector<Fix>& fixes = drive.document.fixes;
  const Graph& graph = drive.document.graph;
  Series series{.name = "fix - fused", .mark = Mark::line, .look = Look::raw};
  for (const Fix& fix : fixes) {
    const auto v = graph.find(fix.vertex);
    if (!v) continue;
    const auto pose = graph.value(*v);
    const Eigen::Vector2d antenna =
        Eigen::Vector2d(pose[0], pose[1]) + Eigen::Rotation2Dd(pose[2]) * drive.document.antenna_m;
    const double seconds = drive.seconds(fix.stamp);
    series.x.push_back(seconds);
    series.y.push_back((fix.position - antenna).norm());
    series.time.push_back(seconds);
  }
  figure.series.push_back(std::move(series));
  return figure;
}

Figure error_distribution(const ReportedDrive& drive) {
  Figure figure;
  figure.id = "error-distribution";
  figure.title = "Distribution of the position error";
  figure.x = {.title = "position error", .unit = "m", .low = 0};
  figure.y = {.title = "epochs with a smaller error", .unit = "%", .low = 0, .high = 100};
  figure.motion = Motion::x;
  figure.series = {distribution(drive, &EpochResult::gnss_offset_m, "raw GNSS", Look::raw),
                   distribution(drive, &EpochResult::fused_offset_m, "fused", Look::fused)};
  const double widest = std::max(figure.series[0].x.empty() ? 0 : figure.series[0].x.back(),
                                 figure.series[1].x.empty() ? 0 : figure.series[1].x.back());
  for (const double level : {50.0, 95.0}) {
    figure.series.push_back({.name = fmt::format("{:g} %", level),
                             .mark = Mark::line,
                             .look = Look::reference,
                             .x = {0, widest},
                             .y = {level, level}});
  }
  const TruthEvaluation& truth = *drive.evaluation.truth;
  figure.description = fmt::format(
      "CEP50 {:.3f} m raw, {:.3f} m fused; CEP95 {:.3f} m raw, {:.3f} m fused: where the curves meet the "
      "dashed lines.",
      truth.gnss.position.cep50_m, truth.fused.position.cep50_m, truth.gnss.position.cep95_m,
      truth.fused.position.cep95_m);
  return figure;
}

Figure autocorrelation_figure(const ReportedDrive& drive) {
  Figure figure;
  figure.id = "autocorrelation";
  figure.title = "Autocorrelation of the error";
  figure.description =
      "Of the errors about their mean, both axes together. 1: the same error still, 0: forgotten. Errors "
      "that last make many fixes worth few, which white noise in a graph denies.";
  figure.x = {.title = "lag", .unit = "s", .low = 0};
  figure.y = {.title = "autocorrelation", .unit = "", .high = 1};
  figure.motion = Motion::x;
  const auto& epochs = drive.evaluation.epochs;
  const double duration = epochs.empty() ? 0 : seconds_between(epochs.front().stamp, epochs.back().stamp);
  const double longest = std::clamp(duration / 4, 1.0, 120.0);
  std::vector<double> lags;
  for (double lag = 1; lag <= longest; lag += longest > 60 ? 2 : 1) lags.push_back(lag);
  for (const auto& [name, look, offset] :
       {std::tuple{"raw GNSS", Look::raw, Offset(&EpochResult::gnss_offset_m)},
        std::tuple{"fused", Look::fused, Offset(&EpochResult::fused_offset_m)}}) {
    std::vector<Stamp> stamps;
    for (const EpochResult& epoch : epochs) {
      if (epoch.*offset) stamps.push_back(epoch.stamp);
    }
    Series series{.name = name, .mark = Mark::line, .look = look};
    series.x = lags;
    series.y = error_autocorrelation(stamps, offsets(drive, offset), lags);
    series.x.insert(series.x.begin(), 0);
    series.y.insert(series.y.begin(), 1);
    figure.series.push_back(std::move(series));
  }
  figure.series.push_back({.name = "1/e",
                           .mark = Mark::line,
                           .look = Look::reference,
                           .x = {0, longest},
                           .y = {std::exp(-1.0), std::exp(-1.0)}});
  return figure;
}

std::vector<Figure> consistency_figures(const ReportedDrive& drive) {
  // Radius of the circle that holds a share p of a Gaussian of sigma 1 in the plane: sqrt(-2 ln (1 - p)).
  const double bound95 = std::sqrt(InnovationStatistics::kBound95);
  Series points{.name = "epoch", .mark = Mark::points, .look = Look::fused};
  std::vector<double> ratios;  // sqrt(NEES)
  for (const EpochResult& epoch : drive.evaluation.epochs) {
    if (!epoch.position_covariance || !epoch.fused_offset_m || !std::isfinite(epoch.nees)) continue;
    points.x.push_back(std::sqrt(epoch.position_covariance->trace() / 2));
    points.y.push_back(epoch.fused_offset_m->norm());
    points.time.push_back(drive.seconds(epoch.stamp));
    ratios.push_back(std::sqrt(epoch.nees));
  }
  if (ratios.size() < 2) return {};
  const double widest = 1.05 * *std::max_element(points.x.begin(), points.x.end());

  Figure by_sigma;
  by_sigma.id = "sigma-error";
  by_sigma.title = "Stated sigma against actual error";
  by_sigma.description =
      "Stated sigma (root mean square of both axes) of each fused position and its distance from the truth. "
      "An honest sigma leaves 39 % of the points below the first line and 95 % below the second.";
  by_sigma.x = {.title = "stated sigma", .unit = "m", .low = 0};
  by_sigma.y = {.title = "position error", .unit = "m", .low = 0};
  by_sigma.square = false;
  by_sigma.width = 430;
  by_sigma.height = 340;
  by_sigma.series = {std::move(points)};
  for (const double factor : {1.0, bound95}) {
    by_sigma.series.push_back({.name = fmt::format("{:.3g} sigma", factor),
                               .mark = Mark::line,
                               .look = factor == 1.0 ? Look::reference : Look::truth,
                               .x = {0, widest},
                               .y = {0, factor * widest}});
  }

  Figure shares;
  shares.id = "coverage";
  shares.title = "Coverage";
  shares.description =
      "Share of epochs whose truth lies in the region that is stated to hold a share p of them. Below the "
      "diagonal the stated covariances are too small, above it too large.";
  shares.x = {.title = "stated", .unit = "%", .low = 0, .high = 100};
  shares.y = {.title = "found", .unit = "%", .low = 0, .high = 100};
  shares.width = 430;
  shares.height = 340;
  std::sort(ratios.begin(), ratios.end());
  Series found{.name = "fused", .mark = Mark::line, .look = Look::fused, .x = {0}, .y = {0}};
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    found.x.push_back(100 * (1 - std::exp(-0.5 * ratios[i] * ratios[i])));
    found.y.push_back(100 * static_cast<double>(i + 1) / static_cast<double>(ratios.size()));
  }
  found.x.push_back(100);
  found.y.push_back(100);
  shares.series = {
      std::move(found),
      {.name = "honest", .mark = Mark::line, .look = Look::reference, .x = {0, 100}, .y = {0, 100}}};

  Figure nees = time_figure(drive, "nees", "NEES over time",
                            "Squared error in units of the stated covariance: 2 on average and below 5.99 at "
                            "95 % of the epochs where the covariance is honest.",
                            {.title = "NEES", .unit = "", .low = 0});
  nees.series.push_back(over_time(drive, "fused", Look::fused, [](const EpochResult& e) {
    return std::isfinite(e.nees) ? std::optional(e.nees) : std::nullopt;
  }));
  nees.series.push_back({.name = "95 % bound",
                         .mark = Mark::line,
                         .look = Look::reference,
                         .x = {*nees.x.low, *nees.x.high},
                         .y = {InnovationStatistics::kBound95, InnovationStatistics::kBound95}});
  return {std::move(by_sigma), std::move(shares), std::move(nees)};
}

}  // namespace waymark
