/// What odometry can be made of where no log holds speed and yaw rate side by side: channels, each with its
/// own times.
#pragma once

#include <vector>

#include <waymark/core/drive/sample.hpp>

namespace waymark::formats {

/// All channels, none of them required; their names are the quantities under `columns` of an odometry part:
/// `speed` (m/s), `yaw_rate` (rad/s, counter-clockwise), `wheel_speed_front_left` .. `_rear_right` (m/s),
/// `wheel_ticks_front_left` .. `_rear_right` and `wheel_ticks` (running counts), `distance` (running, m),
/// `steering_angle` (of the front wheels or the steering wheel, rad, counter-clockwise), `gyro_x`, `_y`, `_z`
/// (rad/s about the sensor's axes, right-handed), `acceleration_x`, `_y`, `_z` (specific force along them,
/// m/s^2), `reverse` (not 0: driving backwards, for speeds and ticks without a sign).
[[nodiscard]] const std::vector<SensorColumn>& odometry_channels();

/// `speed`, `speed_accuracy` (m/s), `course`, `course_accuracy` (rad, clockwise from true north; 1 sigma):
/// quantities of the gnss stream, none required.
[[nodiscard]] const std::vector<SensorColumn>& velocity_channels();

}  // namespace waymark::formats
