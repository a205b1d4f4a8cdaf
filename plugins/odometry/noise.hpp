/// Process noise of the odometry: additive, so that neither the log's rate nor a split at a fix changes the
/// result.
#pragma once

#include <Eigen/Core>

#include <waymark/core/drive/sample.hpp>

namespace waymark::plugins::odometry {

/// Variances that grow with the way and with time. The defaults put the position sigma after 1 km at 10 m/s
/// at 1.1 % (the paper's drift), nearly all of it through the heading: q_heading L^3 / 3 (derivation in
/// README.md).
struct ProcessNoise {
  double longitudinal_per_m = 2e-3;  ///< m^2 per m
  double lateral_per_m = 5e-4;       ///< m^2 per m
  double position_per_s = 1e-4;      ///< m^2 per s, both axes: what a floor per edge would be, made additive
  double heading_per_m = 2.05e-7;    ///< rad^2 per m
  double heading_per_s = 1.5e-6;     ///< rad^2 per s
  double gap_factor = 100;           ///< on all of them where the odometry has a gap
};

/// Noise of a standing vehicle.
struct StandstillNoise {
  double position_per_s = 1e-5;  ///< m^2 per s
  double heading_per_s = 1e-6;   ///< rad^2 per s
  double largest = 1e-5;         ///< m^2, rad^2 per edge: information never below 1e5 (the paper's figure)
};

/// Covariance of the motion over an interval, in the body frame at its end, order (x, y, heading): the
/// integral over tau of Ad(exp(-xi tau)) Q Ad(exp(-xi tau))^T. Composing the halves of an interval gives that
/// of the whole.
[[nodiscard]] Eigen::Matrix3d process_covariance(const Interval& interval, const ProcessNoise& noise);

/// Diagonal covariance of a standstill of dt seconds.
[[nodiscard]] Eigen::Matrix3d standstill_covariance(double dt_s, const StandstillNoise& noise);

/// The paper's literal covariance: 1.1 % of the distance and of the turn of each edge by itself, not below
/// 1e-5 m^2 and 1e-6 rad^2. Depends on the log's rate; only for reproducing the paper.
[[nodiscard]] Eigen::Matrix3d paper_covariance(const Interval& interval);

}  // namespace waymark::plugins::odometry
