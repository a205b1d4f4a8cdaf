/// A time of the odometry, by its samples.
#pragma once

#include <cstddef>
#include <span>

#include <waymark/core/drive/sample.hpp>

namespace waymark::drive {

/// Samples [first, last]. What is found has this as its base, and says what is wrong with them.
struct SampleRange {
  std::size_t first = 0;
  std::size_t last = 0;

  [[nodiscard]] std::size_t size() const { return last - first + 1; }
  /// Returns the samples, of which the span is const or not.
  template <typename Sample>
  [[nodiscard]] std::span<Sample> of(std::span<Sample> odometry) const {
    return odometry.subspan(first, size());
  }
  /// Returns the time from the first to the last sample.
  [[nodiscard]] double duration_s(std::span<const OdometrySample> odometry) const {
    return seconds_between(odometry[first].stamp, odometry[last].stamp);
  }
};

}  // namespace waymark::drive
