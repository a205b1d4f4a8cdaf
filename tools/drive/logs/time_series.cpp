#include <waymark/tools/drive/logs/time_series.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::drive {
namespace {

/// Returns the index of the first reading after the moment.
std::size_t first_after(const TimeSeries& series, Stamp moment) {
  return static_cast<std::size_t>(std::upper_bound(series.stamps.begin(), series.stamps.end(), moment) -
                                  series.stamps.begin());
}

/// Interpolates between readings i - 1 and i.
double between(const TimeSeries& series, std::size_t i, Stamp moment) {
  const double share =
      seconds_between(series.stamps[i - 1], moment) / seconds_between(series.stamps[i - 1], series.stamps[i]);
  return series.values[i - 1] + share * (series.values[i] - series.values[i - 1]);
}

double value_held(const TimeSeries& series, Stamp moment) {
  const std::size_t i = first_after(series, moment);
  if (i == 0) return series.values.front();
  if (i == series.stamps.size()) return series.values.back();
  return between(series, i, moment);
}

}  // namespace

TimeSeries series_of(const std::vector<OdometrySample>& odometry, double OdometrySample::*quantity) {
  TimeSeries series;
  for (const OdometrySample& sample : odometry) {
    series.stamps.push_back(sample.stamp);
    series.values.push_back(sample.*quantity);
  }
  return series;
}

double median_interval_s(const TimeSeries& series) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < series.stamps.size(); ++i)
    intervals.push_back(seconds_between(series.stamps[i - 1], series.stamps[i]));
  return intervals.empty() ? 0 : upper_median(std::move(intervals));
}

double longest_silence_s(const TimeSeries& series, double gap_s) {
  return std::max(gap_s, 2.5 * median_interval_s(series));
}

std::optional<double> value_at(const TimeSeries& series, Stamp moment, double gap_s) {
  const std::size_t i = first_after(series, moment);
  if (i == 0) return std::nullopt;
  if (series.stamps[i - 1] == moment) return series.values[i - 1];
  if (i == series.stamps.size() || seconds_between(series.stamps[i - 1], series.stamps[i]) > gap_s)
    return std::nullopt;
  return between(series, i, moment);
}

TimeSeries unwrapped(TimeSeries angles) {
  for (std::size_t i = 1; i < angles.values.size(); ++i)
    angles.values[i] = angles.values[i - 1] + wrap_angle(angles.values[i] - angles.values[i - 1]);
  return angles;
}

double mean_slope(const TimeSeries& series, Stamp from, Stamp to) {
  if (from == to) return 0;
  return (value_held(series, to) - value_held(series, from)) / seconds_between(from, to);
}

SeriesIntegral::SeriesIntegral(const TimeSeries& series)
    : series_(series), integral_(series.stamps.size(), 0.0) {
  for (std::size_t i = 1; i < integral_.size(); ++i)
    integral_[i] = integral_[i - 1] + 0.5 * (series.values[i - 1] + series.values[i]) *
                                          seconds_between(series.stamps[i - 1], series.stamps[i]);
}

double SeriesIntegral::mean(Stamp from, Stamp to) const {
  if (from == to) return value_held(series_, from);
  return (integral_to(to) - integral_to(from)) / seconds_between(from, to);
}

double SeriesIntegral::integral_to(Stamp moment) const {
  const std::size_t i = first_after(series_, moment);
  if (i == 0) return -series_.values.front() * seconds_between(moment, series_.stamps.front());
  const double since = seconds_between(series_.stamps[i - 1], moment);
  return integral_[i - 1] + 0.5 * (series_.values[i - 1] + value_held(series_, moment)) * since;
}

}  // namespace waymark::drive
