#include <waymark/formats/logs/detail/ros/ros_message.hpp>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>

#include <nlohmann/json.hpp>

#include <waymark/formats/logs/detail/common/gps_time.hpp>
#include <waymark/formats/logs/detail/ros/wire_cursor.hpp>

namespace waymark::formats {
namespace {

struct TypeName {
  std::string_view name;
  RosType type;
};
constexpr std::array kRosTypeNames{
    TypeName{"sensor_msgs/NavSatFix", RosType::nav_sat_fix},
    TypeName{"foxglove.LocationFix", RosType::nav_sat_fix},
    TypeName{"geometry_msgs/Twist", RosType::twist},
    TypeName{"geometry_msgs/TwistStamped", RosType::twist_stamped},
    TypeName{"nav_msgs/Odometry", RosType::odometry},
    TypeName{"sensor_msgs/Imu", RosType::imu},
};

std::optional<Stamp> stamp_of(std::int64_t seconds, std::int64_t nanoseconds) {
  // The range of ROS 1 and of ROS 2; JSON may say anything.
  constexpr std::int64_t kMostSeconds = 0xFFFFFFFF;
  if (seconds < 0 || seconds > kMostSeconds || nanoseconds < 0 || nanoseconds >= kSecondNanoseconds)
    return std::nullopt;
  if (seconds == 0 && nanoseconds == 0) return std::nullopt;
  return Stamp{seconds * kSecondNanoseconds + nanoseconds};
}

/// The yaw of a rotation; NaN for a quaternion that is none, as drivers without a heading send.
double yaw_of(double x, double y, double z, double w) {
  const double norm = std::sqrt(x * x + y * y + z * z + w * w);
  if (!(std::abs(norm - 1) < 0.01)) return RosReading::kNone;
  return std::atan2(2 * (w * z + x * y), w * w + x * x - y * y - z * z);
}

/// An Imu without an orientation says so by -1 in the first element of its covariance.
constexpr double kNotMeasured = -1;

/// std_msgs/Header. ROS 1 begins it with a running number.
void read_header(WireCursor& from, bool ros1, RosReading& reading) {
  if (ros1) (void)from.get<std::uint32_t>();
  const auto seconds =
      ros1 ? std::int64_t{from.get<std::uint32_t>()} : std::int64_t{from.get<std::int32_t>()};
  const auto nanoseconds = from.get<std::uint32_t>();
  (void)from.text();
  reading.stamp = stamp_of(seconds, nanoseconds);
}

Eigen::Vector3d read_vector(WireCursor& from) {
  Eigen::Vector3d vector;
  for (double& value : vector) value = from.get<double>();
  return vector;
}

void skip_numbers(WireCursor& from, int count) {
  for (int i = 0; i < count; ++i) (void)from.get<double>();
}

void read_twist(WireCursor& from, RosReading& reading) {
  reading.speed_mps = read_vector(from).x();
  reading.yaw_rate_radps = read_vector(from).z();
}

void read_fix(WireCursor& from, RosReading& reading) {
  reading.status = from.get<std::int8_t>();
  (void)from.get<std::uint16_t>();  // service
  reading.latitude_deg = from.get<double>();
  reading.longitude_deg = from.get<double>();
  reading.height_m = from.get<double>();
  for (double& value : reading.covariance_enu) value = from.get<double>();
  reading.covariance_type = from.get<std::uint8_t>();
}

void read_odometry(WireCursor& from, RosReading& reading) {
  (void)from.text();           // child_frame_id
  skip_numbers(from, 7 + 36);  // pose and covariance: in a frame of its own
  read_twist(from, reading);
  skip_numbers(from, 36);
}

void read_imu(WireCursor& from, RosReading& reading) {
  const Eigen::Vector3d axis = read_vector(from);
  const auto w = from.get<double>();
  const bool oriented = from.get<double>() != kNotMeasured;
  skip_numbers(from, 8);
  if (oriented) reading.heading_rad = yaw_of(axis.x(), axis.y(), axis.z(), w);
  reading.gyro_radps = read_vector(from);
  skip_numbers(from, 9);
  reading.acceleration_mps2 = read_vector(from);
  skip_numbers(from, 9);
}

const char* read_wire(RosType type, WireCursor from, bool ros1, RosReading& reading) {
  if (type != RosType::twist) read_header(from, ros1, reading);
  switch (type) {
    case RosType::nav_sat_fix:
      read_fix(from, reading);
      break;
    case RosType::twist:
    case RosType::twist_stamped:
      read_twist(from, reading);
      break;
    case RosType::odometry:
      read_odometry(from, reading);
      break;
    case RosType::imu:
      read_imu(from, reading);
      break;
    case RosType::other:
      break;
  }
  return from.sound() ? nullptr : "the message is shorter than its type";
}

const char* read_cdr(RosType type, std::string_view bytes, RosReading& reading) {
  constexpr std::size_t kEncapsulation = 4;
  if (bytes.size() < kEncapsulation) return "the message is shorter than its type";
  // CDR_BE, CDR_LE, and PLAIN_CDR2 of the same orders, whose numbers are aligned to 4 bytes at most.
  const int kind = static_cast<unsigned char>(bytes[0]) << 8 | static_cast<unsigned char>(bytes[1]);
  if (kind != 0 && kind != 1 && kind != 6 && kind != 7) return "its CDR encapsulation is not a plain one";
  const WireCursor from(bytes.substr(kEncapsulation), kind % 2 == 0, kind < 2 ? 8 : 4);
  return read_wire(type, from, false, reading);
}

using Json = nlohmann::json;

/// Returns a member of a member; null if there is none.
const Json* json_member(const Json& object, std::initializer_list<const char*> path) {
  const Json* at = &object;
  for (const char* name : path) {
    if (!at->is_object()) return nullptr;
    const auto found = at->find(name);
    if (found == at->end()) return nullptr;
    at = &*found;
  }
  return at;
}

double json_number(const Json& object, std::initializer_list<const char*> path) {
  const Json* found = json_member(object, path);
  return found != nullptr && found->is_number() ? found->get<double>() : RosReading::kNone;
}

std::optional<std::int64_t> json_whole(const Json& object, std::initializer_list<const char*> path) {
  const Json* found = json_member(object, path);
  if (found == nullptr || !found->is_number_integer()) return std::nullopt;
  return found->get<std::int64_t>();
}

/// The names of the parts of a time differ between ROS 1, ROS 2 and Foxglove.
std::optional<Stamp> json_stamp(const Json& object) {
  const Json* time = json_member(object, {"header", "stamp"});
  if (time == nullptr) time = json_member(object, {"timestamp"});
  if (time == nullptr) return std::nullopt;
  auto seconds = json_whole(*time, {"sec"});
  if (!seconds) seconds = json_whole(*time, {"secs"});
  auto nanoseconds = json_whole(*time, {"nanosec"});
  if (!nanoseconds) nanoseconds = json_whole(*time, {"nsec"});
  if (!nanoseconds) nanoseconds = json_whole(*time, {"nsecs"});
  if (!seconds || !nanoseconds) return std::nullopt;
  return stamp_of(*seconds, *nanoseconds);
}

const char* read_json_fix(const Json& object, RosReading& reading) {
  reading.latitude_deg = json_number(object, {"latitude"});
  reading.longitude_deg = json_number(object, {"longitude"});
  reading.height_m = json_number(object, {"altitude"});
  reading.status =
      static_cast<int>(std::clamp<std::int64_t>(json_whole(object, {"status", "status"}).value_or(0), -1, 3));
  reading.covariance_type = static_cast<unsigned>(
      std::clamp<std::int64_t>(json_whole(object, {"position_covariance_type"}).value_or(0), 0, 3));
  const Json* covariance = json_member(object, {"position_covariance"});
  const bool nine = covariance != nullptr && covariance->is_array() && covariance->size() == 9;
  if (!nine) reading.covariance_type = 0;
  for (std::size_t i = 0; nine && i < 9; ++i)
    reading.covariance_enu[i] =
        (*covariance)[i].is_number() ? (*covariance)[i].get<double>() : RosReading::kNone;
  // JSON has no NaN: a place that is not known is null.
  const bool told =
      json_member(object, {"latitude"}) != nullptr && json_member(object, {"longitude"}) != nullptr;
  return told ? nullptr : "the JSON has no latitude and longitude";
}

const char* read_json_twist(const Json& object, std::initializer_list<const char*> path,
                            RosReading& reading) {
  const Json* twist = json_member(object, path);
  if (twist == nullptr) return "the JSON has no twist";
  reading.speed_mps = json_number(*twist, {"linear", "x"});
  reading.yaw_rate_radps = json_number(*twist, {"angular", "z"});
  return nullptr;
}

const char* read_json_imu(const Json& object, RosReading& reading) {
  constexpr std::array kAxes{"x", "y", "z"};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    reading.gyro_radps[axis] = json_number(object, {"angular_velocity", kAxes[i]});
    reading.acceleration_mps2[axis] = json_number(object, {"linear_acceleration", kAxes[i]});
  }
  const Json* covariance = json_member(object, {"orientation_covariance"});
  const bool oriented = covariance == nullptr || !covariance->is_array() || covariance->empty() ||
                        (*covariance)[0] != kNotMeasured;
  if (oriented)
    reading.heading_rad =
        yaw_of(json_number(object, {"orientation", "x"}), json_number(object, {"orientation", "y"}),
               json_number(object, {"orientation", "z"}), json_number(object, {"orientation", "w"}));
  return json_member(object, {"angular_velocity"}) != nullptr ? nullptr : "the JSON has no angular_velocity";
}

/// The parser calls itself for every bracket, so a message of brackets alone would use up the stack.
bool is_deep(std::string_view text) {
  constexpr int kDeepest = 32;
  int depth = 0;
  for (const char c : text) {
    if (c == '{' || c == '[') ++depth;
    if (c == '}' || c == ']') --depth;
    if (depth > kDeepest) return true;
  }
  return false;
}

const char* read_json(RosType type, std::string_view bytes, RosReading& reading) {
  if (is_deep(bytes)) return "its JSON is nested too deeply";
  const Json object = Json::parse(bytes, nullptr, false);
  if (!object.is_object()) return "it is no JSON object";
  reading.stamp = json_stamp(object);
  switch (type) {
    case RosType::nav_sat_fix:
      return read_json_fix(object, reading);
    case RosType::twist:
      return read_json_twist(object, {}, reading);
    case RosType::twist_stamped:
      return read_json_twist(object, {"twist"}, reading);
    case RosType::odometry:
      return read_json_twist(object, {"twist", "twist"}, reading);
    case RosType::imu:
      return read_json_imu(object, reading);
    case RosType::other:
      break;
  }
  return nullptr;
}

}  // namespace

RosType ros_type(std::string_view name) {
  // ROS 2 puts "msg" between package and type.
  std::string plain(name);
  if (const std::size_t at = plain.find("/msg/"); at != std::string::npos) plain.erase(at, 4);
  for (const TypeName& known : kRosTypeNames)
    if (known.name == plain) return known.type;
  return RosType::other;
}

RosEncoding ros_encoding(std::string_view name) {
  if (name == "cdr") return RosEncoding::cdr;
  if (name == "ros1") return RosEncoding::ros1;
  if (name == "json") return RosEncoding::json;
  return RosEncoding::other;
}

const char* read_ros_message(RosType type, RosEncoding encoding, std::string_view bytes,
                             RosReading& reading) {
  switch (encoding) {
    case RosEncoding::cdr:
      return read_cdr(type, bytes, reading);
    case RosEncoding::ros1:
      return read_wire(type, WireCursor(bytes), true, reading);
    case RosEncoding::json:
      return read_json(type, bytes, reading);
    case RosEncoding::other:
      break;
  }
  return "its encoding is not known";
}

}  // namespace waymark::formats
