/// The drive's nodes in time: one at every odometry stamp and one at every GNSS epoch, with the constant
/// twist that the vehicle followed between neighbours.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/sample.hpp>

namespace waymark::drive {

/// What to do where the odometry has no sample for longer than `gap_s`.
enum class GapPolicy {
  bridge,  ///< keep the mean twist of both sides, process noise inflated by `gap_noise_factor`
  error    ///< refuse the drive
};

/// The largest snap_s that makes sense: at 30 m/s already 1.5 m.
inline constexpr double kLargestSnap = 0.05;

struct TimelineOptions {
  double snap_s =
      0.001;           ///< a GNSS epoch this near to an odometry stamp shares its node; in [0, kLargestSnap]
  double gap_s = 0.5;  ///< a longer interval between odometry samples is a gap; > 0
  GapPolicy gap_policy = GapPolicy::bridge;
  double gap_noise_factor = 100;  ///< variance factor of a bridged interval; >= 1
};

struct Timeline {
  std::vector<Stamp> stamps;          ///< of the n nodes, strictly increasing
  std::vector<Interval> intervals;    ///< n - 1
  std::vector<std::size_t> fix_node;  ///< node of each fix given
};

/// Builds nodes and intervals.
/// Between odometry samples k and k+1 the twist is the mean of the two; an interval split at a fix keeps that
/// twist on both parts. The speed is multiplied by the grid scale of the fix nearest in time to the middle of
/// the odometry interval. Fixes outside the odometry's span must have been dropped before.
/// @param odometry sorted by stamp, stamps unique, at least 2
/// @param fixes    sorted by stamp
/// @throws InputError for fewer than two samples, a gap under GapPolicy::error, a fix outside the odometry's
/// span; UsageError for samples out of order.
[[nodiscard]] Timeline build_timeline(std::span<const OdometrySample> odometry, std::span<const Fix> fixes,
                                      const TimelineOptions& options);

/// Poses of all nodes by exact integration of the intervals from `start`; headings are *not* wrapped, so that
/// windings can be read off. An interval with |speed| below `standstill_mps` is the identity.
[[nodiscard]] std::vector<Eigen::Vector3d> dead_reckon(const Timeline& timeline, const Eigen::Vector3d& start,
                                                       double standstill_mps);

/// For each fix of the timeline the pose of its node moved to the antenna (heading kept): what the gate
/// compares with the fixes. @param antenna_m antenna in the body frame (x forward, y left)
[[nodiscard]] std::vector<Eigen::Vector3d> antenna_at_fixes(const Timeline& timeline,
                                                            std::span<const Eigen::Vector3d> poses,
                                                            const Eigen::Vector2d& antenna_m);

}  // namespace waymark::drive
