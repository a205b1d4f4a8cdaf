/// Statistics of the channels of an odometry log.
#pragma once

#include <string>
#include <vector>

#include <waymark/core/drive/log_reader.hpp>
#include <waymark/tools/inspection/survey/running_statistics.hpp>

namespace waymark::inspection {

/// One channel: speed, yaw rate, a wheel, or an axis of a gyro.
struct ChannelSummary {
  std::string name;
  std::string unit;
  StampSeries stamps;
  Range range;
  double percent95 = 0;  ///< 95 % quantile of |value|
};

struct OdometrySummary {
  std::vector<ChannelSummary> channels;  ///< those that have values
  StampSeries stamps;                    ///< of all rows
  /// 95 % quantile of |yaw rate| while the speed is above 5 m/s, in rad/s. Without a speed in the
  /// log it is over all readings. NaN: there is no yaw rate.
  double yaw_rate_driving = 0;
  std::string yaw_channel;  ///< the channel it was computed from
};

/// Takes the odometry or the readings of a log. Memory does not grow.
class OdometryStatistics {
 public:
  /// @param channels of the readings, as in LogRequest::readings
  explicit OdometryStatistics(const std::vector<SensorColumn>& channels);
  void add(const OdometrySample& sample);
  void add(const SensorTable& readings);
  [[nodiscard]] OdometrySummary summary() const;

 private:
  struct Channel {
    std::string name, unit;
    StampSeries stamps;
    Range range;
    Quantiles sizes, sizes_driving;
  };
  void add_value(Channel& channel, Stamp stamp, double value);

  std::vector<Channel> channels_;
  Channel* speed_channel_ = nullptr;
  Channel* yaw_channel_ = nullptr;
  StampSeries stamps_;
  double speed_ = 0;
};

}  // namespace waymark::inspection
