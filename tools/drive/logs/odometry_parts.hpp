/// Odometry from pieces: speed here, yaw rate there, wheel speeds, ticks, a gyro on any axis, each with its
/// own times, become samples on one clock.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/core/drive/sample.hpp>

namespace waymark::drive {

/// What speed can be made of, in the order of preference. `rear_wheels`: the mean of both; the rear axle is
/// the body point. `front_wheels`: the same; in a curve they run 1 / cos(steering angle of the axle) faster.
/// `..._ticks`: counts per time.
inline constexpr std::array<std::string_view, 7> kSpeedSources{
    "speed", "rear_wheels", "front_wheels", "rear_ticks", "front_ticks", "ticks", "distance"};
/// What yaw rate can be made of: `rear_wheels`, `rear_ticks`: (right - left) / track width; `steering`: speed
/// times the tangent of the front wheels' angle / wheelbase.
inline constexpr std::array<std::string_view, 5> kYawRateSources{"yaw_rate", "gyro", "rear_wheels",
                                                                 "rear_ticks", "steering"};
/// Which axis of a gyro points up: with '-' the one that points down. `gravity`: found from the
/// accelerometer.
inline constexpr std::array<std::string_view, 7> kGyroAxes{"x", "-x", "y", "-y", "z", "-z", "gravity"};

/// How odometry is put together. Empty and 0 stand for: not stated.
struct OdometryAssembly {
  double rate_hz = 0;  ///< of the common clock; not stated: that of the yaw rate's channel, at most 50
  std::string_view speed_from;  ///< not stated: the first that the channels give
  std::string_view yaw_rate_from;
  std::string_view gyro_axis;
  double track_width_m = 0;  ///< between the rear wheels
  double wheelbase_m = 0;
  double steering_ratio = 1;  ///< angle of the steering wheel per angle of the front wheels
  double metres_per_tick = 0;
  double tick_range = 0;  ///< counters start again from 0 here; not stated: never
};

/// The channels of one log.
struct OdometryPart {
  SensorTable readings;  ///< columns as odometry_channels(), NaN where a row has no value; stamps on the
                         ///< drive's scale
  std::string file;      ///< for messages
};

struct AssembledOdometry {
  std::vector<OdometrySample> samples;
  std::vector<std::string> notes;  ///< what was made of what
};

/// Samples at whole multiples of the clock's period from the later first reading to the earlier last one.
/// Each is the mean over its period of the channel, taken as linear between its readings: so the turn and the
/// way in between are kept whatever the rates. A reading that is missing for longer than gap_s (and 2.5 usual
/// intervals of its channel) leaves a gap.
/// @throws InputError for channels given twice, for a missing source of speed or yaw rate, and for a quantity
/// of the vehicle that a source needs and nobody stated
[[nodiscard]] AssembledOdometry assemble_odometry(std::span<const OdometryPart> parts,
                                                  const OdometryAssembly& how, double gap_s);

}  // namespace waymark::drive
