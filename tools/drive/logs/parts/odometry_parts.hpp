/// Assembles odometry from parts: speed, yaw rate, wheel speeds, ticks, a gyro on any axis, a
/// heading. Each part has its own times; the result is samples on one clock.
#pragma once

#include <array>
#include <functional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/core/drive/sample.hpp>

namespace waymark::drive {

/// The sources of speed, in order of preference. `rear_wheels` is the mean of both, because the
/// rear axle is the body point. `front_wheels` is the same for the front; in a curve they run
/// faster by 1 / cos(steering angle of the axle). `..._ticks` are counts per time.
inline constexpr std::array<std::string_view, 7> kSpeedSources{
    "speed", "rear_wheels", "front_wheels", "rear_ticks", "front_ticks", "ticks", "distance"};
/// The sources of yaw rate. `rear_wheels`, `rear_ticks`: (right - left) / track width. `steering`:
/// speed times the tangent of the front wheels' angle / wheelbase. `heading`: its change per time,
/// the shorter way round between readings.
inline constexpr std::array<std::string_view, 7> kYawRateSources{
    "yaw_rate", "gyro", "rear_wheels", "rear_ticks", "steering", "heading", "course"};
/// Tells whether a source of the yaw rate computes it from wheels or steering. @param source empty: it does not
[[nodiscard]] bool is_from_wheels_or_steering(std::string_view source);
/// The gyro axis that points up; with '-' it points down. `gravity`: it is found with the
/// accelerometer.
inline constexpr std::array<std::string_view, 7> kGyroAxes{"x", "-x", "y", "-y", "z", "-z", "gravity"};

/// How odometry is assembled. Empty and 0 mean: not stated.
struct OdometryAssembly {
  /// of the common clock; not stated: that of the yaw rate channel, at most 50
  double rate_hz = 0;
  std::string_view speed_from;  ///< not stated: the first one for which there are channels
  std::string_view yaw_rate_from;
  std::string_view gyro_axis;
  double track_width_m = 0;  ///< between the rear wheels
  double wheelbase_m = 0;
  double steering_ratio = 1;  ///< angle of the steering wheel over angle of the front wheels
  double metres_per_tick = 0;
  double tick_range = 0;           ///< here counters restart from 0; not stated: never
  bool heading_is_course = false;  ///< AssembledOdometry::heading_is_course of an earlier stretch
  bool goes_on = false;            ///< more readings follow: a course is not carried on beyond its last one
};

/// The channels of one log.
struct OdometryPart {
  /// columns as in odometry_channels(), NaN if a row has no value; stamps on the scale of the drive
  SensorTable readings;
  std::string file;  ///< for messages
  /// Channels that were found by the default names of their columns, beside others that are stated. They serve
  /// where nothing else does.
  std::set<std::string, std::less<>> by_default{};
};

struct AssembledOdometry {
  std::vector<OdometrySample> samples;
  std::vector<std::string> notes;     ///< the source of each quantity
  std::vector<std::string> warnings;  ///< of a yaw rate that is missing most of the time
  std::string_view yaw_rate_from;     ///< one of kYawRateSources
  /// the heading leaps at rest, so it is used as a course (parts/direction.hpp); a warning tells it
  bool heading_is_course = false;
};

/// Returns samples at whole multiples of the clock's period, from the later first reading to the
/// earlier last one. Each sample is the mean of the channel over its period, with linear
/// interpolation between readings. So turn and distance are kept, whatever the rates. If a reading
/// is missing for longer than gap_s (and 2.5 usual intervals of its channel), there is a gap.
/// @throws InputError for channels given twice, for a missing source of speed or yaw rate, and for
/// a vehicle parameter that a source needs and that is not stated. Sources of stated channels come before
/// those of OdometryPart::by_default; of wheels, which serve the speed too, only if their track width is stated.
[[nodiscard]] AssembledOdometry assemble_odometry(std::span<const OdometryPart> parts,
                                                  const OdometryAssembly& how, double gap_s);

}  // namespace waymark::drive
