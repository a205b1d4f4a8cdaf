/// The messages of a trajectory: the same numbers in the forms of ROS 1 and ROS 2.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/formats/trajectory/trajectory.hpp>

namespace waymark::formats {

/// The form of a message: ROS 2 aligns numbers to their size behind an encapsulation header (CDR, little endian);
/// ROS 1 does not, and its header has a running number.
enum class RosForm { ros1, ros2 };

/// A topic that is written.
struct RosTopic {
  std::string_view name;
  std::string_view package, type;  ///< "nav_msgs", "Odometry"
  std::string_view md5;            ///< of the definition, as ROS 1 computes it
};
inline constexpr RosTopic kOdometryTopic{"/waymark/odometry", "nav_msgs", "Odometry",
                                         "cd5e73d190d741a2f92e81eda573aca7"};
inline constexpr RosTopic kFixTopic{"/waymark/fix", "sensor_msgs", "NavSatFix",
                                    "2d3a8cd499b9b4a0249fb98fd05cfa48"};

/// Returns the definition of the type with those that it uses, as both containers carry it.
[[nodiscard]] std::string ros_definition(const RosTopic& topic, RosForm form);

/// Returns the stamps of all points as Unix nanoseconds. @throws OutputError that names the point
[[nodiscard]] std::vector<std::int64_t> ros_stamps(std::string_view format,
                                                   std::span<const TrajectoryPoint> points);

/// Returns an Odometry message of a point.
[[nodiscard]] std::string odometry_message(std::span<const TrajectoryPoint> points, std::size_t index,
                                           std::span<const std::int64_t> stamps, RosForm form);
/// Returns a NavSatFix of a point whose place is known.
[[nodiscard]] std::string fix_message(std::span<const TrajectoryPoint> points, std::size_t index,
                                      std::span<const std::int64_t> stamps, RosForm form);

}  // namespace waymark::formats
