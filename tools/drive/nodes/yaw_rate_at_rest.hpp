/// What the yaw rate of the odometry shows while the vehicle stands.
#pragma once

#include <span>

#include <waymark/core/drive/sample.hpp>

namespace waymark::drive {

/// The yaw rate while the vehicle stands (below 0.05 m/s). A gyro shows its bias and noise there; a
/// yaw rate from wheels or steering always reads the same.
struct YawRateAtRest {
  double seconds = 0;         ///< between readings
  double variance_per_s = 0;  ///< white noise of its integral, rad^2/s, from successive differences

  bool stated_derived = false;  ///< the drive.yaml takes it from wheels or steering

  [[nodiscard]] bool is_known() const { return seconds >= 5; }
  [[nodiscard]] bool is_derived() const { return stated_derived || (is_known() && variance_per_s == 0); }
};

[[nodiscard]] YawRateAtRest yaw_rate_at_rest(std::span<const OdometrySample> odometry,
                                             bool stated_derived = false);

}  // namespace waymark::drive
