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

/// Tells whether a sample is a reading at rest: below 0.05 m/s, and not marked as a turn on the spot.
[[nodiscard]] bool is_at_rest(const OdometrySample& sample);

/// Turns on the spot do not count if they are marked.
[[nodiscard]] YawRateAtRest yaw_rate_at_rest(std::span<const OdometrySample> odometry,
                                             bool stated_derived = false);

/// Marks the samples at which the vehicle turns without moving, however slowly (a robot, a turntable): for two
/// seconds or more the mean yaw rate at rest is another than the usual one by 0.015 rad/s, and by five
/// deviations of its noise. The bias of a gyro does not change by so much during a stop.
void mark_turns_on_spot(std::span<OdometrySample> odometry);

}  // namespace waymark::drive
