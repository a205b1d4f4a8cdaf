/// The nodes of a drive in time: one at every odometry stamp and one at every GNSS epoch. Between
/// consecutive nodes the vehicle follows a constant twist.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/sample.hpp>

namespace waymark::drive {

/// The treatment of odometry gaps longer than `gap_s`.
enum class GapPolicy {
  bridge,  ///< keep the mean twist of both sides; `gap_noise_factor` inflates the process noise
  error    ///< refuse the drive
};

/// The largest sensible snap_s: at 30 m/s it is already 1.5 m.
inline constexpr double kLargestSnap = 0.05;

struct TimelineOptions {
  /// a GNSS epoch this near to an odometry stamp shares its node; in [0, kLargestSnap]
  double snap_s = 0.001;
  double gap_s = 0.5;  ///< a longer interval between odometry samples is a gap; > 0
  GapPolicy gap_policy = GapPolicy::bridge;
  double gap_noise_factor = 100;  ///< variance factor of a bridged interval; >= 1
};

struct Timeline {
  std::vector<Stamp> stamps;          ///< of the n nodes, strictly increasing
  std::vector<Interval> intervals;    ///< n - 1
  std::vector<std::size_t> fix_node;  ///< node of each given fix
};

/// Builds nodes and intervals. Between odometry samples k and k+1 the twist is the mean of the two.
/// If a fix splits an interval, both parts keep that twist. The speed is multiplied by the grid
/// scale of the fix nearest in time to the middle of the odometry interval. Fixes outside the span
/// of the odometry must have been dropped before.
/// @param odometry sorted by stamp, stamps unique, at least 2
/// @param fixes sorted by stamp
/// @throws InputError for fewer than two samples, a gap with GapPolicy::error, or a fix outside the
/// span of the odometry; UsageError for samples out of order
[[nodiscard]] Timeline build_timeline(std::span<const OdometrySample> odometry, std::span<const Fix> fixes,
                                      const TimelineOptions& options);

/// Returns the motion between two consecutive odometry samples: the mean of their twists.
///
/// How far the integrals may be off is told by how much speed and yaw rate bend at the samples. If
/// acceleration and angular acceleration wander (white jerk of density s), a second difference over dt has
/// the variance 2/3 s dt^3, and the error of the trapezoid s dt^5 / 120. So the variance of an integral
/// is (second difference times dt)^2 / 80, the mean of those at both ends. The errors that the readings have
/// themselves (OdometrySample::turn_variance_per_s, distance_variance_per_s) come on top.
/// @param grid_scale grid metres per metre on the ground
/// @param gap_s a longer interval is bridged
/// @param before, after the samples around them; null: there is none, or it is not known yet
[[nodiscard]] Interval motion_between(const OdometrySample& left, const OdometrySample& right,
                                      double grid_scale, double gap_s, const OdometrySample* before = nullptr,
                                      const OdometrySample* after = nullptr);

/// Returns the grid scale at a moment: that of the fix nearest in time; 1 without fixes.
/// @param hint 0 for the first of several moments that ascend; it moves forward with the calls
[[nodiscard]] double grid_scale_at(Stamp moment, std::span<const Fix> fixes, std::size_t& hint);

/// Returns poses of all nodes by exact integration of the intervals from `start`. Headings are
/// *not* wrapped, so they show windings. An interval that stands below
/// `standstill_mps` is the identity.
[[nodiscard]] std::vector<Eigen::Vector3d> dead_reckon(const Timeline& timeline, const Eigen::Vector3d& start,
                                                       double standstill_mps);

/// Returns, for each fix of the timeline, the pose of its node moved to the antenna of its receiver (with
/// the same heading), for comparison with the fixes in the gate. @param fixes those of the timeline
[[nodiscard]] std::vector<Eigen::Vector3d> antenna_at_fixes(const Timeline& timeline,
                                                            std::span<const Eigen::Vector3d> poses,
                                                            std::span<const Fix> fixes);
/// Returns the same of a drive that is dead-reckoned from the origin.
[[nodiscard]] std::vector<Eigen::Vector3d> reckoned_antenna(const Timeline& timeline,
                                                            std::span<const Fix> fixes,
                                                            double standstill_mps);

/// How a yaw rate errs: the true one is reading / factor - bias_radps - bias_radpm * speed.
struct YawError {
  double factor = 1;
  double bias_radps = 0;  ///< of a gyro
  double bias_radpm = 0;  ///< of wheels that differ in size, or of a steering wheel that is not straight
};

/// A constant by which the odometry turns more than the fixes: of time or of the way, whichever the chords
/// fit better.
struct YawBias {
  double radps = 0;
  double radpm = 0;
  double sigmas = 0;  ///< how significant it is

  /// Whether it is significant, and poses that are reckoned with it are so bent that they cannot be laid
  /// along fixes.
  [[nodiscard]] bool is_large() const;

  /// Returns it with a factor.
  [[nodiscard]] YawError with(double factor) const { return {factor, radps, radpm}; }
};
/// Returns a drive without an error of its yaw rate. Bridged intervals stay: the motion of the fixes is in
/// them.
[[nodiscard]] Timeline without_error(Timeline timeline, const YawError& error);

}  // namespace waymark::drive
