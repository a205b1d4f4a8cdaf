#include <waymark/formats/trajectory/detail/ros_trajectory.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/common/gps_time.hpp>
#include <waymark/formats/logs/detail/ros/wire_text.hpp>
#include <waymark/formats/text/stamp_text.hpp>

namespace waymark::formats {
namespace {

/// What is not estimated: z, roll, pitch.
constexpr double kUnknownVariance = 1e6;

/// The bytes of one message.
class MessageText {
 public:
  explicit MessageText(RosForm form) : form_(form) {
    if (form_ == RosForm::ros2) bytes_ = std::string("\x00\x01\x00\x00", 4);
    begin_ = bytes_.size();
  }
  template <typename Number>
  MessageText& number(Number value) {
    if (form_ == RosForm::ros2)
      while ((bytes_.size() - begin_) % sizeof(Number) != 0) bytes_ += '\0';
    bytes_ += wire_bytes(value);
    return *this;
  }
  MessageText& text(std::string_view value) {
    // ROS 2 counts and writes the zero byte of C.
    const auto zero = static_cast<std::uint32_t>(form_ == RosForm::ros2 ? 1 : 0);
    number(static_cast<std::uint32_t>(value.size()) + zero);
    bytes_ += value;
    bytes_.append(zero, '\0');
    return *this;
  }
  /// std_msgs/Header; ROS 1 begins it with a running number.
  MessageText& header(std::size_t sequence, std::int64_t stamp, std::string_view frame) {
    if (form_ == RosForm::ros1) number(static_cast<std::uint32_t>(sequence));
    number(static_cast<std::uint32_t>(stamp / kSecondNanoseconds))
        .number(static_cast<std::uint32_t>(stamp % kSecondNanoseconds));
    return text(frame);
  }
  [[nodiscard]] std::string bytes() && { return std::move(bytes_); }

 private:
  RosForm form_;
  std::string bytes_;
  std::size_t begin_ = 0;
};

/// x, y, z, roll, pitch, yaw, row by row.
std::array<double, 36> pose_covariance(const TrajectoryPoint& point) {
  std::array<double, 36> all{};
  if (!point.covariance) return all;
  constexpr std::array<std::size_t, 3> kPlane{0, 1, 5};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      all[6 * kPlane[i] + kPlane[j]] =
          (*point.covariance)(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  for (const std::size_t other : {2U, 3U, 4U}) all[7 * other] = kUnknownVariance;
  return all;
}

/// Forward, left [m/s], yaw rate [rad/s].
Eigen::Vector3d motion_to_next(std::span<const TrajectoryPoint> points, std::size_t index,
                               std::span<const std::int64_t> stamps) {
  if (points.size() < 2) return Eigen::Vector3d::Zero();
  const std::size_t from = std::min(index, points.size() - 2);  // the last pose has that of the one before
  const double dt = static_cast<double>(stamps[from + 1] - stamps[from]) * 1e-9;
  if (!(dt > 0)) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d step = points[from + 1].pose - points[from].pose;
  const double turn = std::remainder(step.z(), 2 * std::numbers::pi);
  // Along the chord of the arc, whose direction is the heading in the middle.
  const double heading = points[from].pose.z() + 0.5 * turn;
  const double c = std::cos(heading);
  const double s = std::sin(heading);
  return {(c * step.x() + s * step.y()) / dt, (c * step.y() - s * step.x()) / dt, turn / dt};
}

constexpr std::string_view kRule =
    "================================================================================\n";
constexpr std::string_view kHeader1 = "uint32 seq\ntime stamp\nstring frame_id\n";
constexpr std::string_view kHeader2 = "builtin_interfaces/Time stamp\nstring frame_id\n";
constexpr std::string_view kTime2 = "int32 sec\nuint32 nanosec\n";

std::string part(std::string_view name, std::string_view text) {
  return fmt::format("{}MSG: {}\n{}", kRule, name, text);
}

std::string headers(RosForm form) {
  if (form == RosForm::ros1) return part("std_msgs/Header", kHeader1);
  return part("std_msgs/Header", kHeader2) + part("builtin_interfaces/Time", kTime2);
}

std::string odometry_definition(RosForm form) {
  const std::string_view header = form == RosForm::ros1 ? "Header header\n" : "std_msgs/Header header\n";
  return std::string(header) +
         "string child_frame_id\ngeometry_msgs/PoseWithCovariance pose\ngeometry_msgs/TwistWithCovariance twist\n" +
         headers(form) + part("geometry_msgs/PoseWithCovariance", "Pose pose\nfloat64[36] covariance\n") +
         part("geometry_msgs/Pose", "Point position\nQuaternion orientation\n") +
         part("geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n") +
         part("geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n") +
         part("geometry_msgs/TwistWithCovariance", "Twist twist\nfloat64[36] covariance\n") +
         part("geometry_msgs/Twist", "Vector3  linear\nVector3  angular\n") +
         part("geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n");
}

std::string fix_definition(RosForm form) {
  const std::string_view header = form == RosForm::ros1 ? "Header header\n" : "std_msgs/Header header\n";
  return std::string(header) +
         "NavSatStatus status\nfloat64 latitude\nfloat64 longitude\nfloat64 altitude\n"
         "float64[9] position_covariance\nuint8 COVARIANCE_TYPE_UNKNOWN = 0\nuint8 COVARIANCE_TYPE_APPROXIMATED = 1\n"
         "uint8 COVARIANCE_TYPE_DIAGONAL_KNOWN = 2\nuint8 COVARIANCE_TYPE_KNOWN = 3\nuint8 position_covariance_type\n" +
         headers(form) +
         part(
             "sensor_msgs/NavSatStatus",
             "int8 STATUS_NO_FIX =  -1\nint8 STATUS_FIX =      0\nint8 STATUS_SBAS_FIX = 1\n"
             "int8 STATUS_GBAS_FIX = 2\nint8 status\nuint16 SERVICE_GPS =     1\nuint16 SERVICE_GLONASS = 2\n"
             "uint16 SERVICE_COMPASS = 4\nuint16 SERVICE_GALILEO = 8\nuint16 service\n");
}

}  // namespace

std::string ros_definition(const RosTopic& topic, RosForm form) {
  return topic.name == kOdometryTopic.name ? odometry_definition(form) : fix_definition(form);
}

std::vector<std::int64_t> ros_stamps(std::string_view format, std::span<const TrajectoryPoint> points) {
  constexpr std::int64_t kEnd = (std::int64_t{1} << 32) * kSecondNanoseconds;
  std::vector<std::int64_t> stamps;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const TrajectoryPoint& point = points[i];
    const Stamp stamp = point.utc.value_or(point.stamp);
    const bool fits = stamp.nanoseconds >= 0 && stamp.nanoseconds < kEnd;
    if (!fits || !point.pose.allFinite())
      throw OutputError(fmt::format("{}: pose {} at {} s: {}", format, i + 1, decimal_seconds(stamp),
                                    fits ? "not finite" : "the stamp is not within 1970 .. 2106"));
    stamps.push_back(stamp.nanoseconds);
  }
  return stamps;
}

std::string odometry_message(std::span<const TrajectoryPoint> points, std::size_t index,
                             std::span<const std::int64_t> stamps, RosForm form) {
  const Eigen::Vector3d& pose = points[index].pose;
  MessageText out(form);
  out.header(index, stamps[index], "map").text("base_link");
  out.number(pose.x()).number(pose.y()).number(0.0);
  out.number(0.0).number(0.0).number(std::sin(0.5 * pose.z())).number(std::cos(0.5 * pose.z()));
  for (const double value : pose_covariance(points[index])) out.number(value);
  const Eigen::Vector3d motion = motion_to_next(points, index, stamps);
  out.number(motion.x()).number(motion.y()).number(0.0).number(0.0).number(0.0).number(motion.z());
  for (int i = 0; i < 36; ++i) out.number(0.0);
  return std::move(out).bytes();
}

std::string fix_message(std::span<const TrajectoryPoint> points, std::size_t index,
                        std::span<const std::int64_t> stamps, RosForm form) {
  const TrajectoryPoint& point = points[index];
  MessageText out(form);
  out.header(index, stamps[index], "base_link");
  out.number(std::int8_t{0}).number(std::uint16_t{1});
  out.number(*point.latitude_deg).number(*point.longitude_deg);
  out.number(std::numeric_limits<double>::quiet_NaN());
  std::array<double, 9> covariance{};
  if (point.covariance) {
    covariance = {(*point.covariance)(0, 0),
                  (*point.covariance)(0, 1),
                  0,
                  (*point.covariance)(1, 0),
                  (*point.covariance)(1, 1),
                  0,
                  0,
                  0,
                  kUnknownVariance};
  }
  for (const double value : covariance) out.number(value);
  out.number(static_cast<std::uint8_t>(point.covariance ? 3 : 0));
  return std::move(out).bytes();
}

}  // namespace waymark::formats
