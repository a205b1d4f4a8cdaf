#include <array>
#include <cstdint>
#include <map>

#include <waymark/formats/logs/detail/common/gps_time.hpp>
#include <waymark/formats/logs/detail/ros/wire_text.hpp>
#include <waymark/formats/trajectory/detail/ros_trajectory.hpp>
#include <waymark/formats/trajectory/ros_formats.hpp>

namespace waymark::formats {
namespace {

constexpr std::array<const RosTopic*, 2> kBagTopics{&kOdometryTopic, &kFixTopic};
/// rosbag writes chunks of this size by default.
constexpr std::size_t kBagChunkSize = 768U << 10U;
/// The first record is padded to this size, so that it can be written again at the end.
constexpr std::size_t kBagFirstRecord = 4096;

std::string bag_field(std::string_view name, std::string_view value) {
  return wire_text(std::string(name) + '=' + std::string(value));
}

std::string bag_op(std::uint8_t op) {
  return bag_field("op", wire_bytes(op));
}

std::string bag_record(const std::string& header, std::string_view data) {
  return wire_text(header) + wire_text(data);
}

/// Seconds and nanoseconds, 4 bytes each.
std::string bag_time(std::int64_t stamp) {
  return wire_bytes(static_cast<std::uint32_t>(stamp / kSecondNanoseconds)) +
         wire_bytes(static_cast<std::uint32_t>(stamp % kSecondNanoseconds));
}

std::string bag_connection(std::uint32_t id) {
  const RosTopic& topic = *kBagTopics[id];
  const std::string type = std::string(topic.package) + '/' + std::string(topic.type);
  return bag_record(bag_op(7) + bag_field("conn", wire_bytes(id)) + bag_field("topic", topic.name),
                    bag_field("topic", topic.name) + bag_field("type", type) +
                        bag_field("md5sum", topic.md5) +
                        bag_field("message_definition", ros_definition(topic, RosForm::ros1)));
}

/// Writes chunks with their indices, and remembers what the end of the bag says of them.
class BagText {
 public:
  void add(std::uint32_t connection, std::int64_t stamp, const std::string& message) {
    if (!known_[connection]) chunk_ += bag_connection(connection);
    known_[connection] = true;
    if (index_.empty()) first_ = last_ = stamp;
    first_ = std::min(first_, stamp);
    last_ = std::max(last_, stamp);
    index_[connection].emplace_back(bag_time(stamp) + wire_bytes(static_cast<std::uint32_t>(chunk_.size())));
    chunk_ += bag_record(
        bag_op(2) + bag_field("conn", wire_bytes(connection)) + bag_field("time", bag_time(stamp)), message);
    if (chunk_.size() > kBagChunkSize) end_chunk();
  }

  std::string text() {
    if (!index_.empty()) end_chunk();
    const std::uint64_t begin_of_index = kBagMagic.size() + kBagFirstRecord + chunks_.size();
    std::uint32_t connections = 0;
    std::string end;
    for (std::uint32_t id = 0; id < kBagTopics.size(); ++id) {
      if (!known_[id]) continue;
      end += bag_connection(id);
      ++connections;
    }
    const std::string header = bag_op(3) + bag_field("index_pos", wire_bytes(begin_of_index)) +
                               bag_field("conn_count", wire_bytes(connections)) +
                               bag_field("chunk_count", wire_bytes(chunk_count_));
    const std::string padding(kBagFirstRecord - 8 - header.size(), ' ');
    return std::string(kBagMagic) + bag_record(header, padding) + chunks_ + end + infos_;
  }

 private:
  void end_chunk() {
    const std::uint64_t place = kBagMagic.size() + kBagFirstRecord + chunks_.size();
    chunks_ += bag_record(bag_op(5) + bag_field("compression", "none") +
                              bag_field("size", wire_bytes(static_cast<std::uint32_t>(chunk_.size()))),
                          chunk_);
    std::string counts;
    for (const auto& [connection, entries] : index_) {
      std::string all;
      for (const std::string& entry : entries) all += entry;
      const auto count = static_cast<std::uint32_t>(entries.size());
      chunks_ +=
          bag_record(bag_op(4) + bag_field("ver", wire_bytes(std::uint32_t{1})) +
                         bag_field("conn", wire_bytes(connection)) + bag_field("count", wire_bytes(count)),
                     all);
      counts += wire_bytes(connection) + wire_bytes(count);
    }
    const auto connections = static_cast<std::uint32_t>(index_.size());
    infos_ +=
        bag_record(bag_op(6) + bag_field("ver", wire_bytes(std::uint32_t{1})) +
                       bag_field("chunk_pos", wire_bytes(place)) + bag_field("start_time", bag_time(first_)) +
                       bag_field("end_time", bag_time(last_)) + bag_field("count", wire_bytes(connections)),
                   counts);
    ++chunk_count_;
    chunk_.clear();
    index_.clear();
  }

  std::string chunk_, chunks_, infos_;
  std::map<std::uint32_t, std::vector<std::string>> index_;  ///< of the current chunk, by connection
  std::array<bool, kBagTopics.size()> known_{};
  std::int64_t first_ = 0, last_ = 0;
  std::uint32_t chunk_count_ = 0;
};

}  // namespace

std::string trajectory_bag(std::span<const TrajectoryPoint> points) {
  const std::vector<std::int64_t> stamps = ros_stamps("bag", points);
  BagText bag;
  for (std::size_t i = 0; i < points.size(); ++i) {
    bag.add(0, stamps[i], odometry_message(points, i, stamps, RosForm::ros1));
    if (points[i].latitude_deg && points[i].longitude_deg)
      bag.add(1, stamps[i], fix_message(points, i, stamps, RosForm::ros1));
  }
  return bag.text();
}

}  // namespace waymark::formats
