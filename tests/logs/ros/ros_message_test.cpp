// Messages of ROS, made here from the definitions of their types (common_interfaces, DDSI-RTPS 2.5).
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <waymark/formats/logs/detail/ros/ros_message.hpp>

#include "logs/ros/ros_bytes.hpp"

namespace ros_message_test {

using namespace waymark;
using namespace waymark::formats;
using waymark_test::Wire;
using waymark_test::WireWriter;

namespace {

constexpr std::int64_t kStamp = 1'700'000'000'250'000'000;

RosEncoding encoding_of(Wire form) {
  return form == Wire::ros1 ? RosEncoding::ros1 : RosEncoding::cdr;
}

RosReading read(RosType type, RosEncoding encoding, const std::string& bytes) {
  RosReading reading;
  const char* error = read_ros_message(type, encoding, bytes, reading);
  INFO((error == nullptr ? "" : error));
  REQUIRE(error == nullptr);
  return reading;
}

std::string complaint(RosType type, RosEncoding encoding, const std::string& bytes) {
  RosReading reading;
  const char* error = read_ros_message(type, encoding, bytes, reading);
  return error == nullptr ? "" : error;
}

std::string imu(Wire form, double first_of_orientation_covariance) {
  const double half =
      std::sqrt(0.5);  // a quarter turn to the left: x, y, z, w = 0, 0, sin 45, cos 45 degrees
  std::vector<double> covariance(9, 0.0);
  covariance[0] = first_of_orientation_covariance;
  return WireWriter(form)
      .header(1'700'000'000, 250'000'000)
      .numbers({0, 0, half, half})
      .numbers(covariance)
      .numbers({0.1, 0.2, 0.3})
      .numbers(std::vector<double>(9, 91))
      .numbers({1, 2, 9.81})
      .numbers(std::vector<double>(9, 92))
      .bytes();
}

}  // namespace

TEST_CASE("ROS messages: NavSatFix has the numbers of its definition in every form of bytes") {
  const Wire form = GENERATE(Wire::ros1, Wire::cdr_little, Wire::cdr_big);
  const RosReading fix =
      read(RosType::nav_sat_fix, encoding_of(form), waymark_test::nav_sat_fix(form, 0, -1));
  CHECK(fix.stamp == Stamp{kStamp});
  CHECK(fix.status == -1);
  CHECK(fix.latitude_deg == 52.5);
  CHECK(fix.longitude_deg == 13.4);
  CHECK(fix.height_m == 80);
  CHECK(fix.covariance_enu == std::array<double, 9>{2.25, 0, 0, 0, 4, 0, 0, 0, 9});
  CHECK(fix.covariance_type == 2);
  CHECK(std::isnan(fix.speed_mps));
}

TEST_CASE("ROS messages: an Imu has angular velocity, acceleration and the yaw of its orientation") {
  const Wire form = GENERATE(Wire::ros1, Wire::cdr_little, Wire::cdr_big);
  const RosReading reading = read(RosType::imu, encoding_of(form), imu(form, 0.01));
  CHECK(reading.stamp == Stamp{kStamp});
  CHECK(reading.gyro_radps == Eigen::Vector3d(0.1, 0.2, 0.3));
  CHECK(reading.acceleration_mps2 == Eigen::Vector3d(1, 2, 9.81));
  CHECK(reading.heading_rad == Approx(std::numbers::pi / 2));
  // "If you have no estimate for one of the data elements, set element 0 of its covariance matrix to -1."
  CHECK(std::isnan(read(RosType::imu, encoding_of(form), imu(form, -1)).heading_rad));
}

TEST_CASE("ROS messages: twists give linear.x and angular.z, and only a stamped one has a time") {
  const Wire form = GENERATE(Wire::ros1, Wire::cdr_little, Wire::cdr_big);
  const std::vector<double> twist{5.5, 51, 52, 53, 54, -0.25};
  const RosReading bare = read(RosType::twist, encoding_of(form), WireWriter(form).numbers(twist).bytes());
  CHECK(bare.speed_mps == 5.5);
  CHECK(bare.yaw_rate_radps == -0.25);
  CHECK_FALSE(bare.stamp.has_value());
  const RosReading stamped = read(RosType::twist_stamped, encoding_of(form),
                                  WireWriter(form).header(1'700'000'000, 250'000'000).numbers(twist).bytes());
  CHECK(stamped.speed_mps == 5.5);
  CHECK(stamped.yaw_rate_radps == -0.25);
  CHECK(stamped.stamp == Stamp{kStamp});
}

TEST_CASE("ROS messages: an Odometry gives its twist, whatever its pose is") {
  const Wire form = GENERATE(Wire::ros1, Wire::cdr_little, Wire::cdr_big);
  const std::string bytes = WireWriter(form)
                                .header(1'700'000'000, 250'000'000)
                                .text("base_link")
                                .numbers(std::vector<double>(7 + 36, 77))
                                .numbers({5.5, 51, 52, 53, 54, -0.25})
                                .numbers(std::vector<double>(36, 78))
                                .bytes();
  const RosReading reading = read(RosType::odometry, encoding_of(form), bytes);
  CHECK(reading.speed_mps == 5.5);
  CHECK(reading.yaw_rate_radps == -0.25);
  CHECK(reading.stamp == Stamp{kStamp});
  CHECK(complaint(RosType::odometry, encoding_of(form), bytes.substr(0, bytes.size() - 1)) ==
        "the message is shorter than its type");
}

TEST_CASE("ROS messages: plain CDR 2 aligns doubles to 4 bytes, CDR 1 to 8") {
  // Behind the encapsulation: stamp 8 bytes, "gps" 4 + 4, status 1, filler 1, service 2: 20 bytes.
  const std::string head = waymark_test::little(std::uint32_t{1}, std::uint32_t{0}, std::uint32_t{4}) +
                           std::string("gps\0\0\0\1\0", 8);
  std::string numbers;
  for (const double value : {52.5, 13.4, 80.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0})
    numbers += waymark_test::little(value);
  numbers += '\1';
  const auto cdr = [&](char kind, const std::string& filler) {
    return std::string({'\0', kind, '\0', '\0'}) + head + filler + numbers;
  };
  CHECK(read(RosType::nav_sat_fix, RosEncoding::cdr, cdr('\1', std::string(4, '\0'))).latitude_deg == 52.5);
  CHECK(read(RosType::nav_sat_fix, RosEncoding::cdr, cdr('\7', "")).latitude_deg == 52.5);
  CHECK(complaint(RosType::nav_sat_fix, RosEncoding::cdr, cdr('\3', "")) ==
        "its CDR encapsulation is not a plain one");
}

TEST_CASE("ROS messages: JSON names the parts of a time as ROS 1, ROS 2 or Foxglove does") {
  const std::string stamp = GENERATE(R"("header":{"stamp":{"secs":1700000000,"nsecs":250000000}})",
                                     R"("header":{"stamp":{"sec":1700000000,"nanosec":250000000}})",
                                     R"("timestamp":{"sec":1700000000,"nsec":250000000})");
  const RosReading fix =
      read(RosType::nav_sat_fix, RosEncoding::json,
           "{" + stamp +
               R"(,"latitude":52.5,"longitude":13.4,"altitude":80,"status":{"status":2},)"
               R"("position_covariance":[2.25,0,0,0,4,0,0,0,9],"position_covariance_type":2})");
  CHECK(fix.stamp == Stamp{kStamp});
  CHECK(fix.latitude_deg == 52.5);
  CHECK(fix.status == 2);
  CHECK(fix.covariance_enu[4] == 4);
  const RosReading twist =
      read(RosType::odometry, RosEncoding::json,
           "{" + stamp + R"(,"twist":{"twist":{"linear":{"x":5.5},"angular":{"z":-0.25}}}})");
  CHECK(twist.speed_mps == 5.5);
  CHECK(twist.yaw_rate_radps == -0.25);
}

TEST_CASE("ROS messages: an error says what the bytes lack") {
  const std::string fix = waymark_test::nav_sat_fix(Wire::ros1, 0);
  for (std::size_t size = 0; size < fix.size(); ++size)
    REQUIRE(complaint(RosType::nav_sat_fix, RosEncoding::ros1, fix.substr(0, size)) ==
            "the message is shorter than its type");
  CHECK(complaint(RosType::imu, RosEncoding::cdr, "\1") == "the message is shorter than its type");
  CHECK(complaint(RosType::imu, RosEncoding::other, fix) == "its encoding is not known");
  CHECK(complaint(RosType::imu, RosEncoding::json, "{}") == "the JSON has no angular_velocity");
  CHECK(complaint(RosType::twist_stamped, RosEncoding::json, "{}") == "the JSON has no twist");
  CHECK(complaint(RosType::nav_sat_fix, RosEncoding::json, "{}") == "the JSON has no latitude and longitude");
  CHECK(complaint(RosType::nav_sat_fix, RosEncoding::json, "[1]") == "it is no JSON object");
  CHECK(complaint(RosType::nav_sat_fix, RosEncoding::json, "{\"latitude\":") == "it is no JSON object");
  CHECK(complaint(RosType::nav_sat_fix, RosEncoding::json, std::string(40, '[')) ==
        "its JSON is nested too deeply");
}

TEST_CASE("ROS messages: types are known by their names in ROS 1 and in ROS 2") {
  CHECK(ros_type("sensor_msgs/NavSatFix") == RosType::nav_sat_fix);
  CHECK(ros_type("sensor_msgs/msg/NavSatFix") == RosType::nav_sat_fix);
  CHECK(ros_type("foxglove.LocationFix") == RosType::nav_sat_fix);
  CHECK(ros_type("geometry_msgs/msg/Twist") == RosType::twist);
  CHECK(ros_type("sensor_msgs/msg/Image") == RosType::other);
  CHECK(ros_encoding("protobuf") == RosEncoding::other);
}

}  // namespace ros_message_test
