#include <waymark/tools/inspection/survey/odometry_statistics.hpp>

#include <cmath>

namespace waymark::inspection {
namespace {

constexpr double kDriving = 5;  // m/s

}  // namespace

OdometryStatistics::OdometryStatistics(const std::vector<SensorColumn>& channels) {
  // plus speed and yaw rate, for a log with complete odometry
  channels_.resize(channels.size() + 2);
  for (std::size_t i = 0; i < channels.size(); ++i) {
    channels_[i].name = channels[i].name;
    channels_[i].unit = channels[i].unit;
  }
  channels_[channels.size()].name = "speed";
  channels_[channels.size()].unit = "m/s";
  channels_[channels.size() + 1].name = "yaw_rate";
  channels_[channels.size() + 1].unit = "rad/s";
  speed_channel_ = &channels_[channels.size()];
  yaw_channel_ = &channels_[channels.size() + 1];
}

void OdometryStatistics::add_value(Channel& channel, Stamp stamp, double value) {
  channel.stamps.add(stamp, 0);
  channel.range.add(value);
  channel.sizes.add(value);
  if (std::abs(speed_) > kDriving) channel.sizes_driving.add(value);
}

void OdometryStatistics::add(const OdometrySample& sample) {
  stamps_.add(sample.stamp, 0);
  speed_ = sample.speed_mps;
  add_value(*speed_channel_, sample.stamp, sample.speed_mps);
  add_value(*yaw_channel_, sample.stamp, sample.yaw_rate_radps);
}

void OdometryStatistics::add(const SensorTable& readings) {
  for (std::size_t row = 0; row < readings.size(); ++row) {
    stamps_.add(readings.stamps[row], 0);
    for (std::size_t column = 0; column < readings.columns; ++column) {
      const double value = readings.at(row, column);
      if (std::isnan(value)) continue;
      if (channels_[column].name == "speed") speed_ = value;
      add_value(channels_[column], readings.stamps[row], value);
    }
  }
}

OdometrySummary OdometryStatistics::summary() const {
  OdometrySummary result;
  result.stamps = stamps_;
  result.yaw_rate_driving = std::nan("");
  const bool has_speed = [&] {
    for (const Channel& channel : channels_)
      if (channel.name == "speed" && channel.range.count > 0) return true;
    return false;
  }();
  for (const Channel& channel : channels_) {
    if (channel.range.count == 0) continue;
    result.channels.push_back(
        {channel.name, channel.unit, channel.stamps, channel.range, channel.sizes.quantile(0.95)});
    if (channel.unit != "rad/s") continue;
    const double driving = has_speed ? channel.sizes_driving.quantile(0.95) : channel.sizes.quantile(0.95);
    if (std::isnan(result.yaw_rate_driving) || driving > result.yaw_rate_driving) {
      result.yaw_rate_driving = driving;
      result.yaw_channel = channel.name;
    }
  }
  return result;
}

}  // namespace waymark::inspection
