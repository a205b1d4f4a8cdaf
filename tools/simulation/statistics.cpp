#include <waymark/tools/simulation/statistics.hpp>

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/tools/drive/nodes/timeline.hpp>
#include <waymark/tools/evaluation/numbers/truth_interpolation.hpp>

namespace waymark::simulation {
namespace {

constexpr double kStandstill = 0.05;  // m/s, as in the odometry models
// m: the noise of 1 cm must not look like driving while the vehicle stands
constexpr double kLeastTruthStep = 0.05;
constexpr double kYawWindow = 60;  // s

double median_of(std::vector<double> values) {
  return values.empty() ? evaluation::kUndefined : upper_median(std::move(values));
}

double median_interval(std::span<const Stamp> stamps) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < stamps.size(); ++i)
    intervals.push_back(seconds_between(stamps[i - 1], stamps[i]));
  return median_of(std::move(intervals));
}

double truth_distance(std::span<const TruthPose> truth) {
  double distance = 0;
  Eigen::Vector2d last = truth.front().position;
  for (const TruthPose& pose : truth) {
    const double step = (pose.position - last).norm();
    if (step < kLeastTruthStep) continue;
    distance += step;
    last = pose.position;
  }
  return distance;
}

std::vector<Stamp> fix_stamps(const drive::PreparedDrive& drive) {
  std::vector<Stamp> stamps;
  for (const Fix& fix : drive.fixes) stamps.push_back(fix.stamp);
  return stamps;
}

/// Returns the true position of the antenna of a fix. Without a heading, antenna and reference point are
/// taken as the same point.
Eigen::Vector2d truth_antenna(const TruthPose& truth, const Fix& fix, const drive::PreparedDrive& drive) {
  if (!truth.heading_rad) return truth.position;
  return truth.position + Eigen::Rotation2Dd(*truth.heading_rad) * (fix.antenna_m - drive.truth_reference_m);
}

void judge_gnss(const drive::PreparedDrive& drive, DriveStatistics& statistics) {
  const std::vector<Stamp> stamps = fix_stamps(drive);
  const evaluation::TruthMatch match = evaluation::interpolate_truth(drive.truth, stamps);
  std::vector<Stamp> matched;
  std::vector<Eigen::Vector2d> offsets;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    if (!match.at[i]) continue;
    matched.push_back(stamps[i]);
    offsets.push_back(drive.fixes[i].position - truth_antenna(match.at[i]->pose, drive.fixes[i], drive));
  }
  statistics.gnss = evaluation::position_metrics(offsets);
  statistics.autocorrelation =
      evaluation::error_autocorrelation(matched, offsets, evaluation::kAutocorrelationLags);
}

/// Returns the median of |heading change of odometry - of truth| over consecutive windows
/// of a minute.
double yaw_drift(std::span<const Stamp> stamps, std::span<const Eigen::Vector3d> odometry,
                 std::span<const Eigen::Vector3d> truth) {
  std::vector<double> changes;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    const double length = seconds_between(stamps[begin], stamps[i]);
    if (length < kYawWindow) continue;
    const double change = std::remainder(odometry[i][2] - truth[i][2] - odometry[begin][2] + truth[begin][2],
                                         2 * std::numbers::pi);
    changes.push_back(std::abs(change) * kYawWindow / length);
    begin = i;
  }
  return median_of(std::move(changes)) * 180 / std::numbers::pi;
}

/// Compares dead reckoning with the truth, at the stamps of the truth within the odometry.
void judge_odometry(const drive::PreparedDrive& drive, const drive::Timeline& timeline,
                    std::span<const Eigen::Vector3d> reckoned, DriveStatistics& statistics) {
  const evaluation::TruthMatch match = evaluation::interpolate_truth(drive.truth, timeline.stamps);
  std::vector<Stamp> stamps;
  std::vector<Eigen::Vector3d> odometry;
  std::vector<Eigen::Vector3d> truth;
  for (std::size_t i = 0; i < timeline.stamps.size(); ++i) {
    if (!match.at[i] || !match.at[i]->pose.heading_rad) continue;
    const TruthPose& pose = match.at[i]->pose;
    const Eigen::Vector2d body =
        pose.position - Eigen::Rotation2Dd(*pose.heading_rad) * drive.truth_reference_m;
    stamps.push_back(timeline.stamps[i]);
    odometry.push_back(reckoned[i]);
    truth.emplace_back(body[0], body[1], *pose.heading_rad);
  }
  statistics.drift_percent = 100 * mean_drift(odometry, truth);
  statistics.yaw_drift_deg_per_minute = yaw_drift(stamps, odometry, truth);
}

}  // namespace

double mean_drift(std::span<const Eigen::Vector3d> odometry, std::span<const Eigen::Vector3d> truth,
                  const DriftOptions& options) {
  std::vector<double> way(truth.size(), 0);
  std::size_t last = 0;
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const double step = (truth[i] - truth[last]).head<2>().norm();
    way[i] = way[last] + (step < kLeastTruthStep ? 0 : step);
    if (step >= kLeastTruthStep) last = i;
  }
  double sum = 0;
  std::size_t pieces = 0;
  double next_start = 0;
  std::size_t end = 0;
  for (std::size_t begin = 0; begin < truth.size(); ++begin) {
    if (way[begin] < next_start) continue;
    next_start = way[begin] + options.start_every_m;
    while (end < truth.size() && way[end] - way[begin] < options.piece_m) ++end;
    if (end == truth.size()) break;
    const Eigen::Rotation2Dd to_truth(truth[begin][2] - odometry[begin][2]);
    const Eigen::Vector2d reached =
        truth[begin].head<2>() + to_truth * (odometry[end] - odometry[begin]).head<2>();
    sum += (reached - truth[end].head<2>()).norm() / (way[end] - way[begin]);
    ++pieces;
  }
  return pieces == 0 ? evaluation::kUndefined : sum / static_cast<double>(pieces);
}

DriveStatistics drive_statistics(const drive::PreparedDrive& drive, const drive::GateOptions& gate) {
  DriveStatistics statistics;
  statistics.duration_s = seconds_between(drive.odometry.front().stamp, drive.odometry.back().stamp);
  statistics.odometry_points = drive.odometry.size();
  statistics.fixes = drive.fixes.size();
  const std::vector<Stamp> stamps = fix_stamps(drive);
  const double interval = median_interval(stamps);
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    const double missing = seconds_between(stamps[i - 1], stamps[i]) / interval - 1;
    if (missing > 0.5) statistics.missing_epochs += static_cast<std::size_t>(std::lround(missing));
  }

  std::vector<Fix> fixes = drive.fixes;
  const drive::Timeline timeline = drive::build_timeline(drive.odometry, fixes, {});
  const std::vector<Eigen::Vector3d> reckoned =
      drive::dead_reckon(timeline, Eigen::Vector3d::Zero(), kStandstill);
  const drive::GateSummary gated =
      drive::apply_gate(fixes, drive::antenna_at_fixes(timeline, reckoned, fixes), gate);
  statistics.rejected = gated.rejected;
  statistics.rejected_percent = gated.rejected_percent();
  if (drive.truth.empty()) return statistics;
  statistics.distance_m = truth_distance(drive.truth);
  judge_gnss(drive, statistics);
  judge_odometry(drive, timeline, reckoned, statistics);
  return statistics;
}

}  // namespace waymark::simulation
