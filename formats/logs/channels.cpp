#include <waymark/formats/logs/channels.hpp>

namespace waymark::formats {

const std::vector<SensorColumn>& odometry_channels() {
  static const std::vector<SensorColumn> channels{
      {"speed", "m/s", "", false, "forward speed, negative when reversing"},
      {"yaw_rate", "rad/s", "ccw", false, "turning rate seen from above"},
      {"wheel_speed_front_left", "m/s", "", false, "circumferential speed of a wheel"},
      {"wheel_speed_front_right", "m/s", "", false, "circumferential speed of a wheel"},
      {"wheel_speed_rear_left", "m/s", "", false, "circumferential speed of a wheel"},
      {"wheel_speed_rear_right", "m/s", "", false, "circumferential speed of a wheel"},
      {"wheel_ticks_front_left", "1", "", false, "running count of a wheel's ticks"},
      {"wheel_ticks_front_right", "1", "", false, "running count of a wheel's ticks"},
      {"wheel_ticks_rear_left", "1", "", false, "running count of a wheel's ticks"},
      {"wheel_ticks_rear_right", "1", "", false, "running count of a wheel's ticks"},
      {"wheel_ticks", "1", "", false, "running count of the drive shaft's ticks"},
      {"distance", "m", "", false, "running distance"},
      {"steering_angle", "rad", "ccw", false, "of the front wheels, or of the steering wheel"},
      {"heading", "rad", "ccw_from_east", false, "heading of the vehicle; only its changes are used"},
      {"course", "rad", "ccw_from_east", false,
       "direction of motion, such as a receiver's course; only its changes while driving are used"},
      {"gyro_x", "rad/s", "ccw", false, "turning rate about the sensor's x axis"},
      {"gyro_y", "rad/s", "ccw", false, "turning rate about the sensor's y axis"},
      {"gyro_z", "rad/s", "ccw", false, "turning rate about the sensor's z axis"},
      {"acceleration_x", "m/s^2", "", false, "specific force along the sensor's x axis"},
      {"acceleration_y", "m/s^2", "", false, "specific force along the sensor's y axis"},
      {"acceleration_z", "m/s^2", "", false, "specific force along the sensor's z axis"},
      {"reverse", "1", "", false, "not 0 if the vehicle drives backwards"},
  };
  return channels;
}

const std::vector<SensorColumn>& velocity_channels() {
  static const std::vector<SensorColumn> channels{
      {"speed", "m/s", "", false, "speed over ground"},
      {"speed_accuracy", "m/s", "", false, "standard deviation of the speed"},
      {"course", "rad", "", false, "course over ground, clockwise from true north"},
      {"course_accuracy", "rad", "", false, "standard deviation of the course"},
  };
  return channels;
}

}  // namespace waymark::formats
