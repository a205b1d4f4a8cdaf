/// Process noise of the odometry. It is additive, so neither the rate of the log nor a split at a
/// fix changes the result.
#pragma once

#include <Eigen/Core>

#include <waymark/core/drive/sample.hpp>

namespace waymark::plugins::odometry {

/// Variances that grow with the distance and with time. With the defaults the position sigma after
/// 1 km at 10 m/s is 1.1 % (the drift in the paper). Nearly all of it comes from the heading:
/// q_heading L^3 / 3 (derivation in README.md).
struct ProcessNoise {
  double longitudinal_per_m = 2e-3;  ///< m^2 per m
  double lateral_per_m = 5e-4;       ///< m^2 per m
  /// m^2 per s, both axes; the additive form of a floor per edge
  double position_per_s = 1e-4;
  double heading_per_m = 2.05e-7;  ///< rad^2 per m
  double heading_per_s = 1.5e-6;   ///< rad^2 per s
  /// In a gap of the odometry: factor on the defaults of all of them, whatever is stated or estimated.
  /// The motion there is unknown, and must not change an estimate of the noise of the sensors.
  double gap_factor = 100;
};

/// The noise of a standing vehicle.
struct StandstillNoise {
  double position_per_s = 1e-5;  ///< m^2 per s
  double heading_per_s = 1e-6;   ///< rad^2 per s
  /// m^2, rad^2 per edge: information is never below 1e5 (the value of the paper)
  double largest = 1e-5;
};

/// Returns the covariance of the motion over an interval, in the body frame at its end, ordered (x,
/// y, heading). It is the integral over tau of Ad(exp(-xi tau)) Q Ad(exp(-xi tau))^T. The halves of
/// an interval compose to the covariance of the whole.
[[nodiscard]] Eigen::Matrix3d process_covariance(const Interval& interval, const ProcessNoise& noise);

/// Returns the diagonal covariance of a standstill of dt seconds.
[[nodiscard]] Eigen::Matrix3d standstill_covariance(double dt_s, const StandstillNoise& noise);

/// Returns the literal covariance of the paper: 1.1 % of the distance and of the turn of each
/// single edge, at least 1e-5 m^2 and 1e-6 rad^2. It depends on the rate of the log, so use it only
/// to reproduce the paper.
[[nodiscard]] Eigen::Matrix3d paper_covariance(const Interval& interval);

}  // namespace waymark::plugins::odometry
