/// What the logs of ROS have in common: topics of typed messages, of which a stream reads one.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/core/drive/log_reader.hpp>
#include <waymark/formats/logs/detail/common/position_stream.hpp>
#include <waymark/formats/logs/detail/ros/ros_message.hpp>

namespace waymark::formats {

/// A channel of a file: messages of one type on one topic.
struct RosChannel {
  std::string topic;
  std::string type_name;  ///< as the file writes it
  RosType type = RosType::other;
  RosEncoding encoding = RosEncoding::other;
};

/// The base of the decoders of MCAP files and bags.
///
/// **Topic**: `topic` among the request's columns names it. Without it the stream reads the only topic that fits:
/// gnss and truth a NavSatFix, odometry a Twist, TwistStamped or Odometry. Odometry in parts and sensors take
/// their quantities from any topic that has them: speed and yaw_rate from twists and Odometry; gyro_*,
/// acceleration_* and heading from an Imu. If two topics fit, or none, finish() throws an InputError that lists
/// all topics.
///
/// **Time** is the stamp of the message's header, and the time of recording if it has none. Both are Unix time.
class RosLogDecoder : public LogDecoder {
 public:
  /// A message on a topic that is read may be this long, bytes; others may have any length.
  static constexpr std::size_t kLongestMessage = 1U << 20U;

  /// @throws InputError for columns other than `topic`, companions, and readings that no message has
  RosLogDecoder(std::string path, LogRequest request, std::string_view format);

  /// Notes and counts of the topics. @throws InputError if no topic fits, or several do
  void finish() final;

 protected:
  /// Called before the notes are written.
  virtual void end() = 0;

  /// Makes a channel known. Many files repeat them; the first counts. @return an error, or null
  const char* add_channel(std::uint32_t id, RosChannel channel);
  /// Counts a message, and tells whether take_message wants its bytes.
  [[nodiscard]] bool wants(std::uint32_t id);
  /// @param log_time when it was recorded, Unix nanoseconds @param place of the message in the file, bytes
  void take_message(std::uint32_t id, std::int64_t log_time, std::string_view bytes, std::uint64_t place);
  /// Counts a record that cannot be used, as "path:byte N: what".
  void corrupt_record(std::uint64_t place, const std::string& what);
  /// Counts an error in a record that is counted already.
  void corrupt(std::uint64_t place, const std::string& what);
  void note(const std::string& text) { data_.notes.push_back(path_ + ": " + text); }
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  struct Topic {
    std::string type_name;
    RosType type = RosType::other;
    std::size_t messages = 0;
    bool read = false;
  };
  struct Known {
    RosChannel channel;
    Topic* topic = nullptr;
  };
  [[nodiscard]] bool fits(const Topic& topic) const;
  [[nodiscard]] bool is_chosen(const std::string& name, const Topic& topic);
  void give(const RosReading& reading, Stamp stamp, std::uint64_t place);
  void give_fix(const RosReading& reading, Stamp stamp, std::uint64_t place);
  void give_readings(const RosReading& reading, Stamp stamp);
  [[nodiscard]] std::string topic_list() const;
  void require_one_topic() const;

  std::string path_;
  LogRequest request_;
  std::string format_;
  std::string wanted_;  ///< topic; empty: the one that fits
  PositionStream positions_;
  std::map<std::uint32_t, Known> channels_;
  std::map<std::string, Topic> topics_;
  std::map<RosType, std::string> chosen_;  ///< the topics that are read; one for each kind of numbers
  std::vector<std::string> rivals_;        ///< topics that fit too
  std::size_t by_log_time_ = 0;
};

}  // namespace waymark::formats
