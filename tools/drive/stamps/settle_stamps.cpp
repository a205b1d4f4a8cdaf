#include <waymark/tools/drive/stamps/settle_stamps.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include <waymark/tools/drive/stamps/bursts.hpp>
#include <waymark/tools/drive/stamps/steps_back.hpp>

namespace waymark::drive {
namespace {

SensorTable table_of(const std::vector<OdometrySample>& samples, std::size_t first) {
  SensorTable table;
  table.columns = 2;
  for (std::size_t i = first; i < samples.size(); ++i) {
    table.stamps.push_back(samples[i].stamp);
    table.values.push_back(samples[i].speed_mps);
    table.values.push_back(samples[i].yaw_rate_radps);
  }
  return table;
}

/// The rows of a table that hold a channel.
struct ChannelRows {
  SensorTable table;
  std::vector<std::size_t> rows;  ///< of the whole table
};

ChannelRows rows_of(const SensorTable& readings, std::size_t column) {
  ChannelRows channel;
  channel.table.columns = 1;
  for (std::size_t row = 0; row < readings.size(); ++row) {
    const double value = readings.at(row, column);
    if (!std::isfinite(value)) continue;
    channel.table.stamps.push_back(readings.stamps[row]);
    channel.table.values.push_back(value);
    channel.rows.push_back(row);
  }
  return channel;
}

/// Returns the table of the channels that nearly all rows hold.
SensorTable common_channels(const SensorTable& readings) {
  std::vector<std::size_t> common;
  for (std::size_t c = 0; c < readings.columns; ++c) {
    std::size_t count = 0;
    for (std::size_t row = 0; row < readings.size(); ++row) count += std::isfinite(readings.at(row, c));
    if (20 * count >= 19 * readings.size()) common.push_back(c);
  }
  SensorTable table;
  table.columns = common.size();
  table.stamps = readings.stamps;
  for (std::size_t row = 0; row < readings.size(); ++row)
    for (const std::size_t c : common) table.values.push_back(readings.at(row, c));
  return table;
}

/// The steps back of the one clock that the channels of a log have.
class StepsOfClock {
 public:
  /// Tells whether no other channel has met a step before. Channels meet it a few intervals of their own
  /// apart, and a step is more than five of them. @param behind the first stamp behind the step @param back_s
  /// its size
  [[nodiscard]] bool is_new(std::size_t channel, Stamp behind, double back_s) {
    const bool is_known = std::any_of(met_.begin(), met_.end(), [&](const Step& other) {
      if (other.channel == channel) return false;
      const double limit_s = 0.5 * std::min(std::abs(back_s), std::abs(other.back_s));
      const double apart_s = seconds_between(other.behind, behind);
      return std::abs(apart_s) < limit_s && std::abs(apart_s + other.back_s - back_s) < limit_s;
    });
    if (!is_known) met_.push_back({channel, behind, back_s});
    return !is_known;
  }

 private:
  struct Step {
    std::size_t channel = 0;
    Stamp behind;
    double back_s = 0;
  };

  std::vector<Step> met_;
};

/// Leaves out the rows that have lost readings and hold no others: their stamps lie in the past.
void leave_out_emptied(SensorTable& readings, const std::vector<char>& has_lost) {
  if (std::none_of(has_lost.begin(), has_lost.end(), [](char lost) { return lost != 0; })) return;
  SensorTable kept;
  kept.columns = readings.columns;
  for (std::size_t row = 0; row < readings.size(); ++row) {
    const std::span<const double> values(&readings.values[row * readings.columns], readings.columns);
    const bool is_empty =
        std::none_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
    if (has_lost[row] != 0 && is_empty) continue;
    kept.stamps.push_back(readings.stamps[row]);
    kept.values.insert(kept.values.end(), values.begin(), values.end());
  }
  readings = std::move(kept);
}

/// Tells of bursts. @returns the stamps that spread them; empty if there are none to spread
std::vector<Stamp> spread_bursts(const SensorTable& rows, const std::string& file,
                                 const std::string& readings, PrepareReport& report) {
  std::optional<Bursts> bursts = find_bursts(rows);
  if (!bursts) return {};
  report.warnings.push_back(warning_of(*bursts, file, readings));
  return std::move(bursts->spread);
}

constexpr const char* kOfOdometry = "readings of the odometry";

}  // namespace

void settle_stamps(std::vector<OdometrySample>& samples, std::size_t first, const std::string& file,
                   PrepareReport& report) {
  const SensorTable table = table_of(samples, first);
  std::vector<char> in_past(table.size(), 0);
  for (const StepBack& step : find_steps_back(table)) {
    report.warnings.push_back(warning_of(step, file, table.size()));
    for (const std::size_t row : step.in_past) in_past[row] = 1;
  }
  std::size_t kept = first;
  for (std::size_t i = 0; i < in_past.size(); ++i)
    if (in_past[i] == 0) samples[kept++] = samples[first + i];
  samples.resize(kept);
  const std::vector<Stamp> spread = spread_bursts(table_of(samples, first), file, kOfOdometry, report);
  for (std::size_t i = 0; i < spread.size(); ++i) samples[first + i].stamp = spread[i];
}

void settle_stamps(SensorTable& readings, const std::string& file, PrepareReport& report) {
  StepsOfClock steps;
  std::vector<char> has_lost(readings.size(), 0);
  for (std::size_t c = 0; c < readings.columns; ++c) {
    const ChannelRows channel = rows_of(readings, c);
    for (const StepBack& step : find_steps_back(channel.table)) {
      if (steps.is_new(c, channel.table.stamps[step.row], step.back_s))
        report.warnings.push_back(warning_of(step, file, channel.table.size()));
      for (const std::size_t row : step.in_past) {
        readings.values[channel.rows[row] * readings.columns + c] = std::numeric_limits<double>::quiet_NaN();
        has_lost[channel.rows[row]] = 1;
      }
    }
  }
  leave_out_emptied(readings, has_lost);
  const auto common = common_channels(readings);
  if (common.columns == 0) return;  // frames of several channels one after another are no bursts
  std::vector<Stamp> spread = spread_bursts(common, file, kOfOdometry, report);
  if (!spread.empty()) readings.stamps = std::move(spread);
}

void settle_bursts(std::span<GeodeticFix> fixes, const std::string& file, PrepareReport& report) {
  SensorTable places;
  places.columns = 2;
  for (const GeodeticFix& fix : fixes) {
    places.stamps.push_back(fix.stamp);
    places.values.push_back(fix.latitude_deg);
    places.values.push_back(fix.longitude_deg);
  }
  const std::vector<Stamp> spread = spread_bursts(places, file, "fixes", report);
  for (std::size_t i = 0; i < spread.size(); ++i) fixes[i].stamp = spread[i];
}

}  // namespace waymark::drive
