#include <cstdint>

#include <zlib.h>

#include <waymark/formats/logs/detail/ros/wire_text.hpp>
#include <waymark/formats/trajectory/detail/ros_trajectory.hpp>
#include <waymark/formats/trajectory/ros_formats.hpp>

namespace waymark::formats {
namespace {

constexpr std::uint16_t kMcapOdometry = 1, kMcapFix = 2;

/// The schema of a topic and its channel, both with the same number.
std::string mcap_topic(const RosTopic& topic, std::uint16_t id) {
  const std::string type = std::string(topic.package) + "/msg/" + std::string(topic.type);
  return mcap_record(McapOpcode::schema, wire_bytes(id) + wire_text(type) + wire_text("ros2msg") +
                                             wire_text(ros_definition(topic, RosForm::ros2))) +
         mcap_record(McapOpcode::channel, wire_bytes(id) + wire_bytes(id) + wire_text(topic.name) +
                                              wire_text("cdr") + wire_bytes(std::uint32_t{0}));
}

std::string mcap_message(std::uint16_t id, std::size_t sequence, std::int64_t stamp,
                         const std::string& bytes) {
  const std::string time = wire_bytes(static_cast<std::uint64_t>(stamp));
  return mcap_record(McapOpcode::message,
                     wire_bytes(id) + wire_bytes(static_cast<std::uint32_t>(sequence)) + time + time + bytes);
}

}  // namespace

std::string trajectory_mcap(std::span<const TrajectoryPoint> points) {
  const std::vector<std::int64_t> stamps = ros_stamps("MCAP", points);
  std::string out(kMcapMagic);
  out += mcap_record(McapOpcode::header, wire_text("ros2") + wire_text("waymark"));
  out += mcap_topic(kOdometryTopic, kMcapOdometry) + mcap_topic(kFixTopic, kMcapFix);
  for (std::size_t i = 0; i < points.size(); ++i) {
    out += mcap_message(kMcapOdometry, i, stamps[i], odometry_message(points, i, stamps, RosForm::ros2));
    if (points[i].latitude_deg && points[i].longitude_deg)
      out += mcap_message(kMcapFix, i, stamps[i], fix_message(points, i, stamps, RosForm::ros2));
  }
  const auto crc =
      static_cast<std::uint32_t>(::crc32_z(0, reinterpret_cast<const Bytef*>(out.data()), out.size()));
  out += mcap_record(McapOpcode::data_end, wire_bytes(crc));
  // Neither summary nor offsets, and no CRC of them.
  out += mcap_record(McapOpcode::footer, std::string(8 + 8 + 4, '\0'));
  return out.append(kMcapMagic);
}

}  // namespace waymark::formats
