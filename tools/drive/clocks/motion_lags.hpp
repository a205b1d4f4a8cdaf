/// How late the speed and the yaw rate of one odometry are, each on its own: they may come from different devices.
///
/// A speed that is late alone (OBD: 0.3 to 0.8 s) puts every bend at the wrong place of the road, by the way of that
/// time; no offset of all stamps mends it. Where each is late shows in the shape of the way: fixes of 20 s lie on the
/// dead reckoning of these 20 s if both lags are right, wherever it begins and in whatever direction.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/sample.hpp>

namespace waymark::drive {

/// Positive: the stamps are late. A delay of the fixes makes both smaller by as much.
struct MotionLags {
  double speed_s = 0;
  double yaw_rate_s = 0;
  Eigen::Matrix2d covariance_s2 = Eigen::Matrix2d::Zero();  ///< of speed_s and yaw_rate_s
  /// How much further ahead than stated the antenna seems. An antenna that is ahead by a knows of bends early by a
  /// over the speed, as if the yaw rate were late.
  double arm_m = 0;

  /// Returns by how much the speed is later than the yaw rate, whatever the delay of the fixes.
  [[nodiscard]] double difference_s() const { return speed_s - yaw_rate_s; }
  /// One standard deviation.
  [[nodiscard]] double difference_sigma_s() const;
};

/// Least squares with Cauchy's loss over speed lag, yaw rate lag, scales of both, bias of the yaw rate and place
/// of the antenna, from positions at least 0.9 s apart in 90 windows at most. The covariance is that of the sums over windows (sandwich):
/// errors of the fixes may be correlated within 20 s. Lags beyond 1.5 s are none of this kind.
/// @param odometry sorted, two samples at least
/// @param fixes of one receiver, sorted by stamp
/// @param arm_sigma_m how well the place of the antenna along the vehicle is known
/// @return empty: there are fewer than 8 windows of 20 s with fixes, fewer than 4 of them tell of one of the lags, even
/// without the three that tell most (one bend after a tunnel says what the fixes in it say), or no lags are within reach
[[nodiscard]] std::optional<MotionLags> estimate_motion_lags(const std::vector<OdometrySample>& odometry,
                                                             const std::vector<const Fix*>& fixes,
                                                             double arm_sigma_m);

}  // namespace waymark::drive
