/// One quantity over time. Straight lines join its readings.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include <waymark/core/drive/sample.hpp>
#include <waymark/core/drive/stamp.hpp>

namespace waymark::drive {

struct TimeSeries {
  std::vector<Stamp> stamps;  ///< ascending
  std::vector<double> values;

  [[nodiscard]] bool empty() const { return stamps.empty(); }
};

/// @param quantity &OdometrySample::speed_mps or &OdometrySample::yaw_rate_radps
[[nodiscard]] TimeSeries series_of(const std::vector<OdometrySample>& odometry,
                                   double OdometrySample::*quantity);

/// Returns the median of the intervals between readings in s; 0 for fewer than two.
[[nodiscard]] double median_interval_s(const TimeSeries& series);

/// Returns how long a series may be silent before that is a gap: the larger of gap_s and 2.5
/// usual intervals.
[[nodiscard]] double longest_silence_s(const TimeSeries& series, double gap_s);

/// Returns the value at an instant. Empty outside the series, and between readings more than
/// `gap_s` apart.
[[nodiscard]] std::optional<double> value_at(const TimeSeries& series, Stamp moment, double gap_s);

/// Returns angles [rad] without jumps by whole turns: each change is the shorter way round.
[[nodiscard]] TimeSeries unwrapped(TimeSeries angles);

/// Returns the mean slope over [from, to] per second; 0 if both are equal. The series is constant
/// beyond its ends.
[[nodiscard]] double mean_slope(const TimeSeries& series, Stamp from, Stamp to);

/// Integrals of a series, each in constant time.
class SeriesIntegral {
 public:
  explicit SeriesIntegral(const TimeSeries& series);
  /// Returns the mean over [from, to]. The series is constant beyond its ends. If both are equal,
  /// returns the value at `from`.
  [[nodiscard]] double mean(Stamp from, Stamp to) const;

 private:
  [[nodiscard]] double integral_to(Stamp moment) const;

  const TimeSeries& series_;
  std::vector<double> integral_;  ///< from the first reading to each
};

}  // namespace waymark::drive
