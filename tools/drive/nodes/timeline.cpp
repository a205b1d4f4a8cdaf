#include <waymark/tools/drive/nodes/timeline.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <optional>

#include <waymark/core/base/error.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::drive {
namespace {

double distance_s(Stamp a, Stamp b) {
  return std::abs(seconds_between(a, b));
}

/// Equal stamps always share a node, because two nodes would have no time between them.
bool shares_node(Stamp a, Stamp b, double snap_s) {
  return a == b || distance_s(a, b) < snap_s;
}

void check_inputs(std::span<const OdometrySample> odometry, std::span<const Fix> fixes,
                  const TimelineOptions& options) {
  if (odometry.size() < 2) throw InputError("the odometry has fewer than two samples");
  if (!(options.snap_s >= 0) || !(options.gap_s > 0))
    throw UsageError("timeline: snap_s must be >= 0 and gap_s > 0");
  const auto unordered = [](const auto& a, const auto& b) { return a.stamp >= b.stamp; };
  if (std::adjacent_find(odometry.begin(), odometry.end(), unordered) != odometry.end())
    throw UsageError("timeline: odometry stamps must increase strictly");
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    if (i > 0 && fixes[i].stamp < fixes[i - 1].stamp)
      throw UsageError("timeline: fixes must be sorted by stamp");
    const bool before = fixes[i].stamp < odometry.front().stamp &&
                        !shares_node(fixes[i].stamp, odometry.front().stamp, options.snap_s);
    const bool after = fixes[i].stamp > odometry.back().stamp &&
                       !shares_node(fixes[i].stamp, odometry.back().stamp, options.snap_s);
    if (before || after) {
      throw InputError("fix of epoch " + std::to_string(fixes[i].epoch) + " lies " +
                       (before ? "before" : "after") + " the odometry's span");
    }
  }
}

void check_gap(Stamp start, Stamp left, double length_s, const TimelineOptions& options) {
  if (options.gap_policy != GapPolicy::error || length_s <= options.gap_s) return;
  char text[200];
  std::snprintf(
      text, sizeof text,
      "gap of %.3f s in the odometry, %.3f s after its start; set gap: policy: bridge or raise gap: "
      "longer_than (%.3f) to go on",
      length_s, seconds_between(start, left), options.gap_s);
  throw InputError(text);
}

/// Appends a node at `stamp`, which ends a part of the motion between two samples. dt is the
/// difference of stamps, so that the parts add up to the whole.
void append_node(Timeline& timeline, Stamp stamp, const Interval& whole, Stamp left, Stamp right) {
  Interval part = whole;
  part.dt_s = seconds_between(timeline.stamps.back(), stamp);
  const double length_s = seconds_between(left, right);
  const double share = part.dt_s / length_s;
  const double middle = seconds_between(left, timeline.stamps.back()) / length_s + 0.5 * share;
  part.speed_mps += (middle - 0.5) * whole.speed_change_mps;
  part.yaw_rate_radps += (middle - 0.5) * whole.yaw_rate_change_radps;
  part.speed_change_mps *= share;
  part.yaw_rate_change_radps *= share;
  part.distance_sigma_m *= std::sqrt(share);
  part.turn_sigma_rad *= std::sqrt(share);
  timeline.stamps.push_back(stamp);
  timeline.intervals.push_back(part);
}

/// How much speed and yaw rate bend at a sample.
struct Bend {
  double speed_mps3 = 0;
  double yaw_rate_radps3 = 0;
};

/// Returns the second derivatives at the middle one of three samples; empty beside a gap.
std::optional<Bend> bend_at(const OdometrySample& before, const OdometrySample& at,
                            const OdometrySample& after, double gap_s) {
  const double first_s = seconds_between(before.stamp, at.stamp);
  const double second_s = seconds_between(at.stamp, after.stamp);
  if (before.assumed || at.assumed || after.assumed || std::max(first_s, second_s) > gap_s) return {};
  const auto bend = [&](double from, double middle, double to) {
    return 2 * ((to - middle) / second_s - (middle - from) / first_s) / (first_s + second_s);
  };
  return Bend{bend(before.speed_mps, at.speed_mps, after.speed_mps),
              bend(before.yaw_rate_radps, at.yaw_rate_radps, after.yaw_rate_radps)};
}

void tell_integration_error(std::initializer_list<std::optional<Bend>> ends, double grid_scale,
                            Interval& interval) {
  constexpr double kShare = 1.0 / 80;
  double speed = 0;
  double yaw_rate = 0;
  double count = 0;
  for (const std::optional<Bend>& end : ends) {
    if (!end) continue;
    speed += end->speed_mps3 * end->speed_mps3;
    yaw_rate += end->yaw_rate_radps3 * end->yaw_rate_radps3;
    ++count;
  }
  if (count == 0) return;
  const double factor = std::sqrt(kShare / count) * interval.dt_s * interval.dt_s * interval.dt_s;
  interval.distance_sigma_m = factor * grid_scale * std::sqrt(speed);
  interval.turn_sigma_rad = factor * std::sqrt(yaw_rate);
}

}  // namespace

Interval motion_between(const OdometrySample& left, const OdometrySample& right, double grid_scale,
                        double gap_s, const OdometrySample* before, const OdometrySample* after) {
  Interval twist;
  twist.dt_s = seconds_between(left.stamp, right.stamp);
  twist.speed_mps = 0.5 * (left.speed_mps + right.speed_mps) * grid_scale;
  twist.yaw_rate_radps = 0.5 * (left.yaw_rate_radps + right.yaw_rate_radps);
  twist.speed_change_mps = (right.speed_mps - left.speed_mps) * grid_scale;
  twist.yaw_rate_change_radps = right.yaw_rate_radps - left.yaw_rate_radps;
  twist.turns_on_spot = left.turns_on_spot && right.turns_on_spot;
  twist.bridged = left.assumed || right.assumed || twist.dt_s > gap_s;
  if (twist.bridged) {
    twist.gap_s = twist.dt_s;
    return twist;
  }
  const auto none = std::optional<Bend>();
  tell_integration_error({before != nullptr ? bend_at(*before, left, right, gap_s) : none,
                          after != nullptr ? bend_at(left, right, *after, gap_s) : none},
                         grid_scale, twist);
  const double turn_variance = 0.5 * (left.turn_variance_per_s + right.turn_variance_per_s) * twist.dt_s;
  twist.turn_sigma_rad = std::hypot(twist.turn_sigma_rad, std::sqrt(turn_variance));
  const double distance_variance =
      0.5 * (left.distance_variance_per_s + right.distance_variance_per_s) * twist.dt_s;
  twist.distance_sigma_m = std::hypot(twist.distance_sigma_m, grid_scale * std::sqrt(distance_variance));
  return twist;
}

double grid_scale_at(Stamp moment, std::span<const Fix> fixes, std::size_t& hint) {
  if (fixes.empty()) return 1;
  const auto away = [&](std::size_t i) { return std::abs(fixes[i].stamp.nanoseconds - moment.nanoseconds); };
  while (hint + 1 < fixes.size() && away(hint + 1) <= away(hint)) ++hint;
  return fixes[hint].grid_scale;
}

Timeline build_timeline(std::span<const OdometrySample> odometry, std::span<const Fix> fixes,
                        const TimelineOptions& options) {
  check_inputs(odometry, fixes, options);
  Timeline timeline;
  timeline.stamps.reserve(odometry.size() + fixes.size());
  timeline.intervals.reserve(odometry.size() + fixes.size());
  timeline.fix_node.reserve(fixes.size());

  std::size_t fix = 0;
  std::size_t scale_hint = 0;
  timeline.stamps.push_back(odometry.front().stamp);
  // Fixes that snap to the last node belong to it.
  const auto attach = [&] {
    while (fix < fixes.size() && (fixes[fix].stamp <= timeline.stamps.back() ||
                                  shares_node(fixes[fix].stamp, timeline.stamps.back(), options.snap_s))) {
      timeline.fix_node.push_back(timeline.stamps.size() - 1);
      ++fix;
    }
  };
  attach();
  for (std::size_t k = 1; k < odometry.size(); ++k) {
    const OdometrySample& left = odometry[k - 1];
    const OdometrySample& right = odometry[k];
    check_gap(odometry.front().stamp, left.stamp, seconds_between(left.stamp, right.stamp), options);
    const Stamp middle{left.stamp.nanoseconds + (right.stamp.nanoseconds - left.stamp.nanoseconds) / 2};
    const Interval twist = motion_between(left, right, grid_scale_at(middle, fixes, scale_hint),
                                          options.gap_s, k > 1 ? &odometry[k - 2] : nullptr,
                                          k + 1 < odometry.size() ? &odometry[k + 1] : nullptr);
    // Epochs strictly inside, not near either end, split the interval.
    while (fix < fixes.size() && fixes[fix].stamp < right.stamp &&
           !shares_node(fixes[fix].stamp, right.stamp, options.snap_s)) {
      append_node(timeline, fixes[fix].stamp, twist, left.stamp, right.stamp);
      attach();
    }
    append_node(timeline, right.stamp, twist, left.stamp, right.stamp);
    attach();
  }
  return timeline;
}

std::vector<Eigen::Vector3d> dead_reckon(const Timeline& timeline, const Eigen::Vector3d& start,
                                         double standstill_mps) {
  std::vector<Eigen::Vector3d> poses;
  poses.reserve(timeline.stamps.size());
  poses.push_back(start);
  Pose2<double> pose(start[0], start[1], start[2]);
  for (const Interval& interval : timeline.intervals) {
    if (!interval.stands(standstill_mps)) {
      const double dt = interval.dt_s;
      const Eigen::Vector3d twist(interval.speed_mps * dt, 0, interval.yaw_rate_radps * dt);
      pose = compose(pose, se2_exp(twist));
    }
    poses.push_back(pose.vector());
  }
  return poses;
}

std::vector<Eigen::Vector3d> antenna_at_fixes(const Timeline& timeline,
                                              std::span<const Eigen::Vector3d> poses,
                                              std::span<const Fix> fixes) {
  std::vector<Eigen::Vector3d> antennas;
  antennas.reserve(timeline.fix_node.size());
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    Eigen::Vector3d pose = poses[timeline.fix_node[i]];
    pose.head<2>() += rotate(pose[2], fixes[i].antenna_seen_m());
    antennas.push_back(pose);
  }
  return antennas;
}

std::vector<Eigen::Vector3d> reckoned_antenna(const Timeline& timeline, std::span<const Fix> fixes,
                                              double standstill_mps) {
  return antenna_at_fixes(timeline, dead_reckon(timeline, Eigen::Vector3d::Zero(), standstill_mps), fixes);
}

bool YawBias::is_large() const {
  constexpr double kSigmas = 5;
  constexpr double kOfTime_radps = 0.01;
  constexpr double kOfWay_radpm = 0.001;  // of two wheels 1.5 m apart, one is larger by 1.5 thousandths
  return sigmas > kSigmas && (std::abs(radps) > kOfTime_radps || std::abs(radpm) > kOfWay_radpm);
}

Timeline without_error(Timeline timeline, const YawError& error) {
  for (Interval& interval : timeline.intervals) {
    if (interval.bridged) continue;
    interval.yaw_rate_radps =
        interval.yaw_rate_radps / error.factor - error.bias_radps - error.bias_radpm * interval.speed_mps;
    interval.yaw_rate_change_radps =
        interval.yaw_rate_change_radps / error.factor - error.bias_radpm * interval.speed_change_mps;
  }
  return timeline;
}

}  // namespace waymark::drive
