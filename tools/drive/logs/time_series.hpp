/// One quantity over time, its readings joined by straight lines.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include <waymark/core/drive/sample.hpp>
#include <waymark/core/drive/stamp.hpp>

namespace waymark::drive {

/// The instant so many seconds later, to the nanosecond.
[[nodiscard]] inline Stamp moved(Stamp stamp, double seconds) {
  return {stamp.nanoseconds + std::llround(seconds * 1e9)};
}

struct TimeSeries {
  std::vector<Stamp> stamps;  ///< ascending
  std::vector<double> values;

  [[nodiscard]] bool empty() const { return stamps.empty(); }
};

/// The upper median. @param values  at least one
[[nodiscard]] double median_of(std::vector<double> values);

/// @param quantity  &OdometrySample::speed_mps or &OdometrySample::yaw_rate_radps
[[nodiscard]] TimeSeries series_of(const std::vector<OdometrySample>& odometry,
                                   double OdometrySample::*quantity);

/// Median of the intervals between readings, s; 0 for fewer than two.
[[nodiscard]] double median_interval_s(const TimeSeries& series);

/// How long a series may be silent before that is a gap: gap_s, and 2.5 of its usual intervals.
[[nodiscard]] double longest_silence_s(const TimeSeries& series, double gap_s);

/// Value at an instant; empty outside the series, and between readings that are more than `gap_s` apart.
[[nodiscard]] std::optional<double> value_at(const TimeSeries& series, Stamp moment, double gap_s);

/// Integrals of a series in constant time each.
class SeriesIntegral {
 public:
  explicit SeriesIntegral(const TimeSeries& series);
  /// Mean over [from, to], the series taken as constant beyond its ends; the value at `from` where both are
  /// equal.
  [[nodiscard]] double mean(Stamp from, Stamp to) const;

 private:
  [[nodiscard]] double integral_to(Stamp moment) const;

  const TimeSeries& series_;
  std::vector<double> integral_;  ///< from the first reading to each
};

}  // namespace waymark::drive
