#include <waymark/tools/drive/velocity.hpp>

#include <cmath>
#include <numbers>
#include <optional>

#include <waymark/tools/drive/time_series.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark {
namespace {

/// A column's values, angles wound on so that lines between readings go the short way round.
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

}  // namespace

std::size_t add_velocity(const SensorTable& readings, std::vector<GeodeticFix>& fixes) {
  const TimeSeries speed = column(readings, 0, false);
  const TimeSeries speed_sigma = column(readings, 1, false);
  const TimeSeries course = column(readings, 2, true);
  const TimeSeries course_sigma = column(readings, 3, false);
  std::size_t given = 0;
  const auto give = [](const TimeSeries& series, Stamp stamp, std::optional<double>& value) {
    const std::optional<double> found = value_at(series, stamp, 2.5 * median_interval_s(series));
    if (found) value = found;
    return found.has_value();
  };
  for (GeodeticFix& fix : fixes) {
    const bool has_speed = give(speed, fix.stamp, fix.speed_mps);
    const bool has_course = give(course, fix.stamp, fix.course_rad);
    if (has_speed) give(speed_sigma, fix.stamp, fix.speed_sigma_mps);
    if (has_course) give(course_sigma, fix.stamp, fix.course_sigma_rad);
    if (has_course) fix.course_rad = std::remainder(*fix.course_rad, 2 * std::numbers::pi);
    given += has_speed || has_course ? 1 : 0;
  }
  return given;
}

}  // namespace waymark
