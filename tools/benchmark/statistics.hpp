/// Median and spread of repeated measurements.
#pragma once

#include <vector>

namespace waymark::benchmark {

struct Spread {
  double median = 0;  ///< for an even number of values: the mean of the two middle ones
  double least = 0;
  double largest = 0;
};

/// @throws UsageError if there are no values
[[nodiscard]] Spread spread_of(std::vector<double> values);

/// Returns the index of the median. For an even number of values it is the lower of the two
/// middle ones.
/// @throws UsageError if there are no values
[[nodiscard]] std::size_t index_of_median(const std::vector<double>& values);

}  // namespace waymark::benchmark
