#include <waymark/tools/drive/logs/velocity.hpp>

#include <cmath>
#include <numbers>
#include <optional>

#include <waymark/tools/drive/logs/time_series.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::drive {
namespace {

/// Returns the values of a column. Angles are unwrapped, so that lines between readings go
/// the short way.
TimeSeries column(const SensorTable& readings, std::size_t c, bool is_angle) {
  TimeSeries series;
  for (std::size_t row = 0; row < readings.size(); ++row) {
    double value = readings.at(row, c);
    if (!std::isfinite(value)) continue;
    if (!series.empty() && readings.stamps[row] <= series.stamps.back()) continue;
    if (is_angle && !series.empty()) value = series.values.back() + wrap_angle(value - series.values.back());
    series.stamps.push_back(readings.stamps[row]);
    series.values.push_back(value);
  }
  return series;
}

/// A channel of the log, and how long it may be silent; its median interval is computed once.
struct Channel {
  Channel(const SensorTable& readings, std::size_t c, bool is_angle)
      : series(column(readings, c, is_angle)), silence_s(longest_silence_s(series, 0)) {}

  /// Sets the value if the channel has one. @return whether it has one
  bool give(Stamp stamp, std::optional<double>& value) const {
    const std::optional<double> found = value_at(series, stamp, silence_s);
    if (found) value = found;
    return found.has_value();
  }

  TimeSeries series;
  double silence_s;
};

}  // namespace

std::size_t add_velocity(const SensorTable& readings, std::span<GeodeticFix> fixes) {
  const Channel speed(readings, 0, false);
  const Channel speed_sigma(readings, 1, false);
  const Channel course(readings, 2, true);
  const Channel course_sigma(readings, 3, false);
  std::size_t given = 0;
  for (GeodeticFix& fix : fixes) {
    const bool has_speed = speed.give(fix.stamp, fix.speed_mps);
    const bool has_course = course.give(fix.stamp, fix.course_rad);
    if (has_speed) speed_sigma.give(fix.stamp, fix.speed_sigma_mps);
    if (has_course) course_sigma.give(fix.stamp, fix.course_sigma_rad);
    if (has_course) fix.course_rad = std::remainder(*fix.course_rad, 2 * std::numbers::pi);
    given += has_speed || has_course ? 1 : 0;
  }
  return given;
}

}  // namespace waymark::drive
