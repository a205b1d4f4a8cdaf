#include <waymark/tools/live/learning/drive_so_far.hpp>

#include <algorithm>
#include <optional>

namespace waymark::live {
namespace {

template <typename Kept>
void forget_before(Stamp moment, std::deque<Kept>& source) {
  while (!source.empty() && source.front().stamp < moment) source.pop_front();
}

template <typename Kept>
void forget_before(Stamp moment, std::vector<std::deque<Kept>>& sources) {
  for (std::deque<Kept>& source : sources) forget_before(moment, source);
}

}  // namespace

DriveSoFar::DriveSoFar(const drive::DriveDescription& description, double kept_s)
    : odometries_(description.odometry.size()),
      fixes_(description.gnss.size()),
      readings_(description.sensors.size()),
      kept_s_(kept_s) {}

void DriveSoFar::take(const Sample& sample) {
  if (const auto* odometry = std::get_if<OdometrySample>(&sample)) {
    odometries_.front().push_back(*odometry);
  } else if (const auto* further = std::get_if<FurtherOdometry>(&sample)) {
    odometries_[further->source].push_back({further->stamp, further->speed_mps, further->yaw_rate_radps});
  } else if (const auto* fix = std::get_if<GeodeticFix>(&sample)) {
    fixes_[static_cast<std::size_t>(fix->source)].push_back(*fix);
  } else {
    const auto& reading = std::get<SensorReading>(sample);
    readings_[reading.sensor].push_back(reading);
  }
  keep_since(stamp_of(sample).later(-kept_s_));
}

void DriveSoFar::keep_since(Stamp oldest) {
  forget_before(oldest, odometries_);
  forget_before(oldest, fixes_);
  forget_before(oldest, readings_);
  forget_before(oldest, pauses_);
}

void DriveSoFar::keep_last(double length_s) {
  std::optional<Stamp> newest;
  for (const auto& samples : odometries_)
    if (!samples.empty()) newest = newest ? std::max(*newest, samples.back().stamp) : samples.back().stamp;
  if (newest) keep_since(newest->later(-length_s));
}

void DriveSoFar::clear() {
  for (auto& odometry : odometries_) odometry.clear();
  for (auto& receiver : fixes_) receiver.clear();
  for (auto& sensor : readings_) sensor.clear();
  pauses_.clear();
}

double DriveSoFar::length_s() const {
  double longest_s = 0;
  for (const auto& samples : odometries_)
    if (!samples.empty())
      longest_s = std::max(longest_s, seconds_between(samples.front().stamp, samples.back().stamp));
  for (const Pause& pause : pauses_) longest_s -= pause.length_s;
  return std::max(longest_s, 0.0);
}

drive::DriveLogs DriveSoFar::logs(const drive::DriveDescription& description) const {
  drive::DriveLogs logs;
  const auto log_named = [&](const std::string& name) {
    drive::DriveLogs::Log log;
    log.scale = description.scale();
    log.file = name;
    return log;
  };
  for (std::size_t i = 0; i < odometries_.size(); ++i) {
    logs.odometry.push_back({log_named(description.odometry[i].name)});
    logs.odometry.back().front().data.odometry.assign(odometries_[i].begin(), odometries_[i].end());
  }
  for (std::size_t i = 0; i < fixes_.size(); ++i) {
    logs.gnss.push_back(log_named(description.gnss[i].name));
    logs.gnss.back().data.fixes.assign(fixes_[i].begin(), fixes_[i].end());
    logs.velocity.emplace_back();
  }
  for (const drive::SensorConfig& sensor : description.sensors)
    logs.sensors.push_back(log_named(sensor.source_name()));
  return logs;
}

std::vector<SensorTable> DriveSoFar::readings() const {
  std::vector<SensorTable> tables;
  for (const std::deque<SensorReading>& sensor : readings_) {
    SensorTable& table = tables.emplace_back();
    for (const SensorReading& reading : sensor) {
      table.columns = reading.values.size();
      table.stamps.push_back(reading.stamp);
      table.values.insert(table.values.end(), reading.values.begin(), reading.values.end());
    }
  }
  return tables;
}

drive::DriveDescription described_so_far(drive::DriveDescription description, const Frame& frame) {
  description.from_s.reset();
  description.to_s.reset();
  description.truth.reset();
  description.first_pose.reset();
  description.outage = {};
  for (drive::OdometryConfig& odometry : description.odometry) {
    odometry.speed_delay_s = 0;
    odometry.yaw_rate_delay_s = 0;
  }
  for (drive::GnssConfig& receiver : description.gnss) {
    receiver.delay_s = 0;
    receiver.withhold_every = 0;
    receiver.withheld = false;
    receiver.velocity.reset();
  }
  description.state_frame(frame);
  return description;
}

}  // namespace waymark::live
