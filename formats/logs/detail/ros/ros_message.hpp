/// Messages of ROS, as MCAP files and bags hold them: which types are read, and how their bytes become numbers.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

#include <Eigen/Core>

#include <waymark/core/drive/stamp.hpp>

namespace waymark::formats {

/// The types of messages that are read; `other` are only counted.
enum class RosType { other, nav_sat_fix, twist, twist_stamped, odometry, imu };

/// Returns the type by its name in either ROS ("sensor_msgs/NavSatFix", "sensor_msgs/msg/NavSatFix"); also
/// foxglove.LocationFix, which has the numbers of a NavSatFix under names of its own.
[[nodiscard]] RosType ros_type(std::string_view name);

/// How the bytes of a message are written. `cdr` is ROS 2's (OMG DDSI-RTPS 2.5, 10: an encapsulation header of
/// 4 bytes that says the byte order, then numbers aligned to their size). `ros1` is little-endian without
/// alignment. `json` is an object with the members of the message.
enum class RosEncoding { other, cdr, ros1, json };

/// Returns the encoding by its name in an MCAP channel: "cdr", "ros1", "json".
[[nodiscard]] RosEncoding ros_encoding(std::string_view name);

/// The numbers of a message. Those that its type does not have are NaN.
struct RosReading {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  /// of its header, Unix time; empty: the type has no header, or the stamp is 0
  std::optional<Stamp> stamp;
  double latitude_deg = kNone;  ///< WGS84
  double longitude_deg = kNone;
  double height_m = kNone;                                 ///< above the ellipsoid
  int status = 0;                                          ///< -1 no fix, 0 fix, 1 SBAS, 2 GBAS
  std::array<double, 9> covariance_enu{};                  ///< m^2, row by row
  unsigned covariance_type = 0;                            ///< 0 unknown, 1 approximated, 2 diagonal, 3 known
  double speed_mps = kNone;                                ///< linear.x of a twist: forward in the body frame
  double yaw_rate_radps = kNone;                           ///< angular.z of a twist: counter-clockwise
  Eigen::Vector3d gyro_radps{kNone, kNone, kNone};         ///< of an Imu, axes of the sensor
  Eigen::Vector3d acceleration_mps2{kNone, kNone, kNone};  ///< of an Imu, specific force
  double heading_rad = kNone;  ///< yaw of an Imu's orientation, counter-clockwise from east (REP 103)
};

/// Reads a message. @return null, or why its bytes are no message of this type
[[nodiscard]] const char* read_ros_message(RosType type, RosEncoding encoding, std::string_view bytes,
                                           RosReading& reading);

}  // namespace waymark::formats
