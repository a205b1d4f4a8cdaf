/// The way of a vehicle by its odometry, if its speed and its yaw rate are late by different times.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/sample.hpp>

namespace waymark::drive {

/// Dead reckoning from distance and turn since the first sample, both on a raster of 0.05 s. They are integrals, so
/// a raster that is wider than the samples loses neither.
class LaggedPath {
 public:
  /// How the readings were wrong. Positive lags: the stamps are late.
  struct Errors {
    double speed_lag_s = 0;
    double yaw_rate_lag_s = 0;
    double bias_radps = 0;  ///< of the yaw rate
    double yaw_scale = 0;   ///< true yaw rate = (1 + scale) reading - bias
  };

  /// @param odometry sorted, two samples at least
  explicit LaggedPath(const std::vector<OdometrySample>& odometry);

  /// Returns seconds after the first sample.
  [[nodiscard]] double seconds_of(Stamp stamp) const { return seconds_between(first_, stamp); }
  [[nodiscard]] double length_s() const { return length_s_; }
  /// Tells whether the odometry measured all the time: no gap, nothing assumed. @param from_s, to_s within the drive
  [[nodiscard]] bool is_measured(double from_s, double to_s) const;
  /// Returns where the antenna was at some moments, in a frame of their own. @param moments_s ascending, one at least,
  /// within the drive @param antenna_m in the body frame
  [[nodiscard]] std::vector<Eigen::Vector2d> antenna_at(std::span<const double> moments_s,
                                                        const Errors& errors,
                                                        const Eigen::Vector2d& antenna_m) const;

 private:
  Stamp first_;
  double length_s_ = 0;
  std::vector<double> distance_m_;  ///< since the first sample, at each point of the raster
  std::vector<double> turn_rad_;
  std::vector<double> unknown_;  ///< how many points so far are in gaps or assumed
};

}  // namespace waymark::drive
