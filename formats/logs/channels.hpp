/// Channels: the sources of odometry if no log holds speed and yaw rate side by side. Each channel
/// has its own times.
#pragma once

#include <vector>

#include <waymark/core/drive/sample.hpp>

namespace waymark::formats {

/// Returns all channels; none of them is required. Their names are the quantities under `columns`
/// of an odometry part:
/// - `speed` (m/s), `yaw_rate` (rad/s, counter-clockwise);
/// - `wheel_speed_front_left` .. `_rear_right` (m/s);
/// - `wheel_ticks_front_left` .. `_rear_right` and `wheel_ticks` (running counts), `distance`
///   (running, m);
/// - `steering_angle` (of the front wheels or the steering wheel, rad, counter-clockwise);
/// - `heading` (rad, counter-clockwise from east, true or on the grid: only its changes are used);
/// - `course` (the same of the direction of motion, which says nothing at rest);
/// - `gyro_x`, `_y`, `_z` (rad/s about the axes of the sensor, right-handed);
/// - `acceleration_x`, `_y`, `_z` (specific force along these axes, m/s^2);
/// - `reverse` (not 0: driving backwards; for speeds and ticks without a sign).
[[nodiscard]] const std::vector<SensorColumn>& odometry_channels();

/// Returns the velocity quantities of the gnss stream; none is required: `speed`, `speed_accuracy`
/// (m/s), `course`, `course_accuracy` (rad, clockwise from true north; 1 sigma).
[[nodiscard]] const std::vector<SensorColumn>& velocity_channels();

}  // namespace waymark::formats
