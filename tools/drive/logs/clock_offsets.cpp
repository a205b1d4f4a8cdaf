#include <waymark/tools/drive/logs/clock_offsets.hpp>

#include <cmath>
#include <cstdint>
#include <limits>

#include <fmt/format.h>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/tools/drive/logs/time_series.hpp>

namespace waymark::drive {
namespace {

constexpr double kAnyGap = std::numeric_limits<double>::infinity();

}  // namespace

std::optional<ClockReport> clock_of(const DriveLogs::Log& log) {
  if (log.data.clocks.empty()) return std::nullopt;
  std::vector<double> ahead;
  for (const ClockPair& pair : log.data.clocks) ahead.push_back(seconds_between(pair.told, pair.logged));
  ClockReport clock{log.file, ahead.size(), upper_median(ahead), 0};
  for (double& value : ahead) value = std::abs(value - clock.ahead_s);
  clock.spread_s = upper_median(std::move(ahead));
  return clock;
}

std::vector<std::string> put_on_told_time(DriveLogs& logs) {
  std::vector<std::string> notes;
  for (DriveLogs::Log& log : logs.gnss) {
    const std::optional<ClockReport> clock = clock_of(log);
    if (!clock) continue;
    const std::int64_t ahead = std::llround(clock->ahead_s * 1e9);
    for (GeodeticFix& fix : log.data.fixes) fix.stamp.nanoseconds -= ahead;
    for (ClockPair& pair : log.data.clocks) pair.logged.nanoseconds -= ahead;
    notes.push_back(
        fmt::format("sync: {}: the stamps were {:.3f} s ahead of the GNSS time in the log; corrected",
                    log.file, clock->ahead_s));
  }
  return notes;
}

std::vector<OdometrySample> without_delays(const std::vector<OdometrySample>& odometry, double speed_delay_s,
                                           double yaw_rate_delay_s) {
  const bool same_sense = speed_delay_s * yaw_rate_delay_s > 0;
  const bool speed_less = std::abs(speed_delay_s) < std::abs(yaw_rate_delay_s);
  const double common = same_sense ? (speed_less ? speed_delay_s : yaw_rate_delay_s) : 0;
  const TimeSeries speed = series_of(odometry, &OdometrySample::speed_mps);
  const TimeSeries yaw_rate = series_of(odometry, &OdometrySample::yaw_rate_radps);
  std::vector<OdometrySample> result;
  for (const OdometrySample& sample : odometry) {
    const auto v = value_at(speed, sample.stamp.later(speed_delay_s - common), kAnyGap);
    const auto w = value_at(yaw_rate, sample.stamp.later(yaw_rate_delay_s - common), kAnyGap);
    if (!v || !w) continue;
    OdometrySample& moved = result.emplace_back(sample);
    moved.stamp = sample.stamp.later(-common);
    moved.speed_mps = *v;
    moved.yaw_rate_radps = *w;
  }
  return result;
}

}  // namespace waymark::drive
