/// The motion of a sensor, put together from pieces of constant twist.
#pragma once

#include <Eigen/Core>

#include <waymark/types_se2/se2.hpp>

namespace waymark::plugins::twist {

/// The motion since the sensor stood at the beginning, in its own frame there.
class SensorWay {
 public:
  /// Appends `seconds` of a constant twist.
  /// @param twist forward [m/s], left [m/s], yaw rate [rad/s]
  /// @param density of the variance of the way, per second: m^2/s, m^2/s, rad^2/s
  void add(const Eigen::Vector3d& twist, const Eigen::Vector3d& density, double seconds);

  [[nodiscard]] double seconds() const { return seconds_; }
  /// Where the sensor stands now, seen from the beginning.
  [[nodiscard]] const Pose2<double>& motion() const { return motion_; }
  /// The constant twist times seconds() that makes the same motion: forward [m], left [m], turn
  /// [rad] in (-pi, pi].
  [[nodiscard]] Eigen::Vector3d mean_way() const { return se2_log(motion_); }
  /// The derivative of the place by a bias of the yaw rate, minus that of mean_way(): m per rad/s,
  /// in the axes of the beginning. It is 0 if the twist did not change.
  [[nodiscard]] Eigen::Vector2d bend() const;
  /// Of the motion, in the axes of the sensor now, ordered (forward, left, turn).
  [[nodiscard]] const Eigen::Matrix3d& covariance() const { return covariance_; }

 private:
  Pose2<double> motion_;
  double seconds_ = 0;
  Eigen::Vector2d place_by_bias_ = Eigen::Vector2d::Zero();
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
};

}  // namespace waymark::plugins::twist
