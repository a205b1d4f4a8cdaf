#include <waymark/formats/logs/detail/ros/ros_log.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/common/log_request.hpp>
#include <waymark/formats/logs/detail/common/record_fields.hpp>

namespace waymark::formats {
namespace {

/// A file with more is no log, and its names would use up the memory.
constexpr std::size_t kRosMostChannels = 4096;
constexpr std::size_t kMostTopicsListed = 20;

/// Returns a topic with its type for people: cut, without bytes that a terminal could take for a command.
std::string shown(const std::string& topic, const std::string& type) {
  constexpr std::size_t kLongest = 100;
  std::string text = fmt::format("{} ({})", topic.substr(0, kLongest), type.substr(0, kLongest));
  const auto is_control = [](unsigned char byte) { return byte < 0x20 || byte == 0x7F; };
  std::replace_if(text.begin(), text.end(), is_control, '?');
  return text;
}

/// A number of a message by the name of a channel (channels.hpp).
struct Source {
  std::string_view name;
  double (*value)(const RosReading&);
  bool of_imu;
};
constexpr std::array kRosSources{
    Source{"speed", [](const RosReading& from) { return from.speed_mps; }, false},
    Source{"yaw_rate", [](const RosReading& from) { return from.yaw_rate_radps; }, false},
    Source{"gyro_x", [](const RosReading& from) { return from.gyro_radps.x(); }, true},
    Source{"gyro_y", [](const RosReading& from) { return from.gyro_radps.y(); }, true},
    Source{"gyro_z", [](const RosReading& from) { return from.gyro_radps.z(); }, true},
    Source{"acceleration_x", [](const RosReading& from) { return from.acceleration_mps2.x(); }, true},
    Source{"acceleration_y", [](const RosReading& from) { return from.acceleration_mps2.y(); }, true},
    Source{"acceleration_z", [](const RosReading& from) { return from.acceleration_mps2.z(); }, true},
    Source{"heading", [](const RosReading& from) { return from.heading_rad; }, true},
};

const Source* find_source(std::string_view name) {
  const auto found = std::find_if(kRosSources.begin(), kRosSources.end(),
                                  [name](const Source& source) { return source.name == name; });
  return found == kRosSources.end() ? nullptr : &*found;
}

bool has_twist(RosType type) {
  return type == RosType::twist || type == RosType::twist_stamped || type == RosType::odometry;
}

/// Topics of one kind give the same numbers, so that only one of them may be read.
RosType kind_of(RosType type) {
  return has_twist(type) ? RosType::twist : type;
}

bool in_range(double value, double most) {
  return std::abs(value) <= most;  // false for NaN
}

}  // namespace

RosLogDecoder::RosLogDecoder(std::string path, LogRequest request, std::string_view format)
    : path_(std::move(path)),
      request_(std::move(request)),
      format_(format),
      positions_(path_, request_, nullptr) {
  require_companions(path_, request_, format_);
  for (const auto& [key, column] : request_.columns) {
    if (key != "topic")
      throw InputError(
          fmt::format("{}: {} has no column for '{}'; only 'topic' may be stated", path_, format_, key));
    wanted_ = column.column;
  }
  if (request_.stream != StreamKind::sensor && request_.readings.empty()) return;
  data_.readings.columns = request_.readings.size();
  bool any = false;
  for (const SensorColumn& column : request_.readings) {
    const bool known = find_source(column.name) != nullptr;
    any = any || known;
    if (!known && column.required)
      throw InputError(
          fmt::format("{}: no message of {} that is read has '{}'", path_, format_, column.name));
  }
  if (!any)
    throw InputError(fmt::format(
        "{}: no message of {} that is read has any of the quantities that are asked for", path_, format_));
}

bool RosLogDecoder::fits(const Topic& topic) const {
  if (request_.readings.empty()) {
    if (request_.stream == StreamKind::odometry) return has_twist(topic.type);
    return topic.type == RosType::nav_sat_fix && request_.stream != StreamKind::sensor;
  }
  return std::any_of(request_.readings.begin(), request_.readings.end(), [&](const SensorColumn& column) {
    const Source* source = find_source(column.name);
    return source != nullptr && (source->of_imu ? topic.type == RosType::imu : has_twist(topic.type));
  });
}

/// Decides at the first message of a topic.
bool RosLogDecoder::is_chosen(const std::string& name, const Topic& topic) {
  if (!fits(topic)) return false;
  if (!wanted_.empty()) return name == wanted_;
  const auto [chosen, first] = chosen_.try_emplace(kind_of(topic.type), name);
  if (!first) rivals_.push_back(name);
  return first;
}

const char* RosLogDecoder::add_channel(std::uint32_t id, RosChannel channel) {
  if (channels_.contains(id)) return nullptr;
  if (channels_.size() >= kRosMostChannels) return "more than 4096 channels";
  channel.type = ros_type(channel.type_name);
  const auto [topic, fresh] = topics_.try_emplace(channel.topic);
  if (fresh) {
    topic->second.type_name = channel.type_name;
    topic->second.type = channel.type;
  }
  channels_[id] = {std::move(channel), &topic->second};
  return nullptr;
}

bool RosLogDecoder::wants(std::uint32_t id) {
  const auto known = channels_.find(id);
  if (known == channels_.end()) return false;
  Topic& topic = *known->second.topic;
  if (topic.messages++ == 0) topic.read = is_chosen(known->second.channel.topic, topic);
  return topic.read && known->second.channel.type == topic.type;
}

void RosLogDecoder::take_message(std::uint32_t id, std::int64_t log_time, std::string_view bytes,
                                 std::uint64_t place) {
  const auto known = channels_.find(id);
  if (known == channels_.end()) return;
  ++data_.records;
  RosReading reading;
  const RosChannel& channel = known->second.channel;
  if (const char* error = read_ros_message(channel.type, channel.encoding, bytes, reading))
    return corrupt(place, fmt::format("{}: {}", quote_field(channel.topic), error));
  if (!reading.stamp) ++by_log_time_;
  const std::optional<Stamp> stamp =
      positions_.stamp(reading.stamp.value_or(Stamp{log_time}), TimeScale::unix_time);
  if (!stamp) return corrupt(place, quote_field(channel.topic) + ": its time is too large for a stamp");
  give(reading, *stamp, place);
}

void RosLogDecoder::give(const RosReading& reading, Stamp stamp, std::uint64_t place) {
  if (!request_.readings.empty()) return give_readings(reading, stamp);
  if (request_.stream != StreamKind::odometry) return give_fix(reading, stamp, place);
  constexpr double kMostSpeed = 150;
  constexpr double kMostRate = 20;
  if (!in_range(reading.speed_mps, kMostSpeed) || !in_range(reading.yaw_rate_radps, kMostRate))
    return corrupt(place, "twist: its linear.x is not within 150 m/s, or its angular.z not within 20 rad/s");
  data_.odometry.push_back({stamp, reading.speed_mps, reading.yaw_rate_radps});
}

void RosLogDecoder::give_fix(const RosReading& reading, Stamp stamp, std::uint64_t place) {
  // Drivers without a fix say so in the status, or by a place that is not a number.
  if (reading.status < 0 || std::isnan(reading.latitude_deg) || std::isnan(reading.longitude_deg)) {
    ++data_.without_fix;
    return;
  }
  if (!in_range(reading.latitude_deg, 90) || !in_range(reading.longitude_deg, 180))
    return corrupt(place,
                   "NavSatFix: its latitude is outside -90 .. 90, or its longitude outside -180 .. 180");
  GeodeticFix fix;
  fix.stamp = stamp;
  fix.latitude_deg = reading.latitude_deg;
  fix.longitude_deg = reading.longitude_deg;
  if (std::isfinite(reading.height_m)) fix.height_m = reading.height_m;
  fix.line = data_.records;
  fix.told.quality = reading.status > 0 ? FixQuality::differential : FixQuality::single;
  StatedAccuracy accuracy{std::nullopt, std::nullopt};
  const auto& c = reading.covariance_enu;
  if (reading.covariance_type > 0) {
    constexpr unsigned kKnown = 3;
    const double correlated = reading.covariance_type == kKnown ? c[1] : 0;
    accuracy.squares_en = (Eigen::Matrix2d() << c[0], correlated, correlated, c[4]).finished();
  }
  if (const char* error = positions_.add(data_, fix, accuracy))
    corrupt(place, std::string("NavSatFix: ") + error);
}

void RosLogDecoder::give_readings(const RosReading& reading, Stamp stamp) {
  data_.readings.stamps.push_back(stamp);
  for (const SensorColumn& column : request_.readings) {
    const Source* source = find_source(column.name);
    const double value = source == nullptr ? RosReading::kNone : source->value(reading);
    data_.readings.values.push_back(std::isfinite(value) ? value : RosReading::kNone);
  }
}

void RosLogDecoder::corrupt_record(std::uint64_t place, const std::string& what) {
  ++data_.records;
  corrupt(place, what);
}

void RosLogDecoder::corrupt(std::uint64_t place, const std::string& what) {
  ++data_.corrupt;
  if (data_.corrupt_examples.size() < kCorruptExamples)
    data_.corrupt_examples.push_back(fmt::format("{}:byte {}: {}", path_, place, what));
}

std::string RosLogDecoder::topic_list() const {
  std::string list;
  std::size_t count = 0;
  for (const auto& [name, topic] : topics_) {
    if (++count > kMostTopicsListed) continue;
    list += fmt::format("{}{} ({}, {} messages)", list.empty() ? "" : ", ", quote_field(name),
                        quote_field(topic.type_name), topic.messages);
  }
  if (count > kMostTopicsListed) list += fmt::format(" and {} more", count - kMostTopicsListed);
  return list;
}

void RosLogDecoder::require_one_topic() const {
  if (topics_.empty()) return;  // what is wrong then has been said otherwise
  if (!rivals_.empty())
    throw InputError(fmt::format("{}: several topics fit; state 'topic'; topics: {}", path_, topic_list()));
  const bool any =
      std::any_of(topics_.begin(), topics_.end(), [](const auto& entry) { return entry.second.read; });
  if (any) return;
  if (!wanted_.empty() && !topics_.contains(wanted_))
    throw InputError(
        fmt::format("{}: there is no topic {}; topics: {}", path_, quote_field(wanted_), topic_list()));
  throw InputError(fmt::format("{}: {} has the messages that are asked for ({}); topics: {}", path_,
                               wanted_.empty() ? "no topic" : quote_field(wanted_) + " is no topic that",
                               request_.stream == StreamKind::odometry
                                   ? "Twist, TwistStamped, Odometry or Imu"
                               : request_.stream == StreamKind::sensor ? "TwistStamped, Odometry or Imu"
                                                                       : "NavSatFix",
                               topic_list()));
}

void RosLogDecoder::finish() {
  end();
  for (const auto& [name, topic] : topics_)
    if (topic.messages > 0) data_.kinds[shown(name, topic.type_name)] += topic.messages;
  if (by_log_time_ > 0)
    note(
        fmt::format("{} messages have no stamp of their own: the time of recording stands in", by_log_time_));
  if (data_.records > by_log_time_) note("stamps are those of the messages' headers, taken as Unix time");
  positions_.finish(data_);
  require_one_topic();
}

}  // namespace waymark::formats
