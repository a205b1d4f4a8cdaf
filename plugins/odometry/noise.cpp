#include <algorithm>
#include <array>
#include <cmath>

#include <waymark/plugins/odometry/detail/noise.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::plugins::odometry {

namespace {

/// Variances per second along and across the vehicle, and of its heading.
Eigen::Vector3d rates(double speed_mps, const ProcessNoise& noise) {
  const double speed = std::abs(speed_mps);
  return {noise.longitudinal_per_m * speed + noise.position_per_s,
          noise.lateral_per_m * speed + noise.position_per_s,
          noise.heading_per_m * speed + noise.heading_per_s};
}

/// What the sensors do, and what is not known of the motion between their readings. Where the yaw rate
/// changes evenly, the constant twist ends v dw dt^2 / 12 beside the way.
Eigen::Vector3d rates_between_readings(const Interval& interval, const ProcessNoise& noise) {
  const double dt = interval.dt_s;
  const Eigen::Vector3d sigma(interval.distance_sigma_m,
                              interval.speed_mps * interval.yaw_rate_change_radps * dt * dt / 12,
                              interval.turn_sigma_rad);
  return rates(interval.speed_mps, noise) + sigma.cwiseAbs2() / dt;
}

/// A vehicle accelerates by about 1 m/s^2 for 2 s and turns faster by about 0.15 rad/s^2 for 1 s: white
/// noise of these densities. Speed and yaw rate are known at both ends of the gap, so that they are
/// Brownian bridges, and the variance of their integral is density gap_s^3 / 12.
Eigen::Vector3d rates_in_gap(const Interval& interval, double factor) {
  constexpr double kAcceleration = 4;            // m^2/s^3
  constexpr double kAngularAcceleration = 0.04;  // rad^2/s^3
  const double bridge = interval.gap_s * interval.gap_s / 12;
  return factor * rates(interval.speed_mps, {}) +
         bridge * Eigen::Vector3d(kAcceleration, kAcceleration, kAngularAcceleration);
}

}  // namespace

Eigen::Matrix3d process_covariance(const Interval& interval, const ProcessNoise& noise) {
  const Eigen::Vector3d rate =
      interval.bridged ? rates_in_gap(interval, noise.gap_factor) : rates_between_readings(interval, noise);
  // Gauss-Legendre quadrature with three points. It is exact for straight motion, because the
  // integrand is quadratic in tau. For turns up to 0.2 rad per interval its relative error is 1e-9.
  const double root = std::sqrt(0.6);
  const std::array<std::pair<double, double>, 3> points = {
      {{0.5 * (1 - root), 5.0 / 18}, {0.5, 8.0 / 18}, {0.5 * (1 + root), 5.0 / 18}}};
  const Eigen::Vector3d twist(interval.speed_mps, 0, interval.yaw_rate_radps);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const auto& [place, weight] : points) {
    const Eigen::Vector3d remaining = -place * interval.dt_s * twist;
    const Eigen::Matrix3d adjoint = se2_adjoint(se2_exp(remaining));
    covariance += weight * interval.dt_s * adjoint * rate.asDiagonal() * adjoint.transpose();
  }
  return covariance;
}

Eigen::Matrix3d standstill_covariance(double dt_s, const StandstillNoise& noise) {
  const double position = std::min(noise.position_per_s * dt_s, noise.largest);
  const double heading = std::min(noise.heading_per_s * dt_s, noise.largest);
  return Eigen::Vector3d(position, position, heading).asDiagonal();
}

Eigen::Matrix3d paper_covariance(const Interval& interval) {
  constexpr double kDrift = 0.011;
  const double distance = interval.speed_mps * interval.dt_s;
  const double turn = interval.yaw_rate_radps * interval.dt_s;
  const double position = std::max(std::pow(kDrift * distance, 2), 1e-5);
  const double heading = std::max(std::pow(kDrift * turn, 2), 1e-6);
  return Eigen::Vector3d(position, position, heading).asDiagonal();
}

}  // namespace waymark::plugins::odometry
