#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <waymark/core/linear/dense_decompositions.hpp>
#include <waymark/tools/report/drive/drive_figures.hpp>
#include <waymark/tools/report/drive/epoch_series.hpp>

namespace waymark::report {
namespace {

constexpr double kDegreesPerRadian = 180 / std::numbers::pi;

drawing::Series ellipse(const Eigen::Vector2d& mean, const Eigen::Matrix2d& covariance, drawing::Look look) {
  const auto [variances, axes] = symmetric_eigen(covariance);
  const Eigen::Matrix2d root = axes * variances.cwiseMax(0).cwiseSqrt().asDiagonal();
  drawing::Series series{.name = "1-sigma ellipse", .mark = drawing::Mark::line, .look = look};
  for (int degrees = 0; degrees <= 360; degrees += 5) {
    const double angle = degrees / kDegreesPerRadian;
    const Eigen::Vector2d point = mean + root * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    series.x.push_back(point.x());
    series.y.push_back(point.y());
  }
  return series;
}

struct Moments {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< about the mean, divisor n - 1
};

Moments moments(const std::vector<Eigen::Vector2d>& all) {
  Moments result;
  const double n = static_cast<double>(all.size());
  for (const Eigen::Vector2d& offset : all) result.mean += offset / n;
  for (const Eigen::Vector2d& offset : all)
    result.covariance += (offset - result.mean) * (offset - result.mean).transpose() / std::max(n - 1, 1.0);
  return result;
}

std::string describe_tile(const std::vector<Eigen::Vector2d>& all, const Moments& of_all, double half_m) {
  const auto outside = std::count_if(all.begin(), all.end(), [&](const Eigen::Vector2d& offset) {
    return offset.cwiseAbs().maxCoeff() > half_m;
  });
  const Eigen::Vector2d sigma = of_all.covariance.diagonal().cwiseSqrt();
  return fmt::format(
      "{} epochs, {} of them outside the tile of {:g} x {:g} m; mean ({:.2f}, {:.2f}) m, |mean| = Acc = "
      "{:.3f} m; the ellipse has the errors' covariance about their mean, sigma east {:.2f} m, north {:.2f} "
      "m.",
      all.size(), outside, 2 * half_m, 2 * half_m, of_all.mean.x(), of_all.mean.y(), of_all.mean.norm(),
      sigma.x(), sigma.y());
}

drawing::Series errors_on_plane(const ReportedDrive& drive, Offset which, drawing::Look look) {
  drawing::Series errors{.name = "error", .mark = drawing::Mark::points, .look = look};
  for (const evaluation::EpochResult& epoch : drive.evaluation.epochs) {
    if (!(epoch.*which)) continue;
    errors.x.push_back((epoch.*which)->x());
    errors.y.push_back((epoch.*which)->y());
    errors.time.push_back(drive.seconds(epoch.stamp));
  }
  return errors;
}

drawing::Figure tile(const ReportedDrive& drive, Offset which, const std::string& name, drawing::Look look,
                     double half_m) {
  const std::vector<Eigen::Vector2d> all = offsets(drive, which);
  const Moments of_all = moments(all);
  drawing::Figure figure;
  figure.id = look == drawing::Look::raw ? "tile-raw" : "tile-fused";
  figure.title = "Error tile, " + name;
  figure.description = describe_tile(all, of_all, half_m);
  figure.x = {.title = "east error", .unit = "m", .low = -half_m, .high = half_m};
  figure.y = {.title = "north error", .unit = "m", .low = -half_m, .high = half_m};
  figure.motion = drawing::Motion::map;
  figure.width = 430;
  figure.height = 440;
  figure.series = {
      errors_on_plane(drive, which, look),
      ellipse(of_all.mean, of_all.covariance, drawing::Look::truth),
      {.name = "mean",
       .mark = drawing::Mark::points,
       .look = drawing::Look::truth,
       .x = {of_all.mean.x()},
       .y = {of_all.mean.y()}},
      {.name = "truth", .mark = drawing::Mark::points, .look = drawing::Look::reference, .x = {0}, .y = {0}}};
  if (half_m > 1) {
    figure.series.push_back({.name = "2 x 2 m",
                             .mark = drawing::Mark::line,
                             .look = drawing::Look::reference,
                             .x = {-1, 1, 1, -1, -1},
                             .y = {-1, -1, 1, 1, -1}});
  }
  return figure;
}

/// Returns half the width of the tile. It is the paper's metre if that contains half of the
/// fused errors, their ellipse and the mean of both systems. Otherwise it is the next round
/// number that does.
double half_width(const ReportedDrive& drive) {
  std::vector<double> largest;
  for (const Eigen::Vector2d& offset : offsets(drive, &evaluation::EpochResult::fused_offset_m))
    largest.push_back(offset.cwiseAbs().maxCoeff());
  std::sort(largest.begin(), largest.end());
  double needed = evaluation::nearest_rank_quantile(largest, 0.5);
  const evaluation::TruthEvaluation& truth = *drive.evaluation.truth;
  needed = std::max(needed, 1.05 * truth.gnss.position.mean_m.cwiseAbs().maxCoeff());
  const double spread =
      std::isfinite(truth.fused.position.precision_m) ? truth.fused.position.precision_m : 0;
  needed = std::max(needed, truth.fused.position.mean_m.cwiseAbs().maxCoeff() + spread);
  for (const double half : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0}) {
    if (!(needed > half)) return half;
  }
  return 1000;
}

}  // namespace

drawing::FigureRow error_tiles(const ReportedDrive& drive) {
  const double half_m = half_width(drive);
  return {{tile(drive, &evaluation::EpochResult::gnss_offset_m, "raw GNSS", drawing::Look::raw, half_m),
           tile(drive, &evaluation::EpochResult::fused_offset_m, "fused", drawing::Look::fused, half_m)}};
}

}  // namespace waymark::report
