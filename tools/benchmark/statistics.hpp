/// Median and spread of repeated measurements.
#pragma once

#include <vector>

namespace waymark::benchmark {

struct Spread {
  double median = 0;  ///< the mean of the two middle ones for an even number
  double least = 0;
  double largest = 0;
};

/// @throws UsageError for no values.
[[nodiscard]] Spread spread_of(std::vector<double> values);

/// Which of the values is the median; for an even number the lower of the two middle ones.
/// @throws UsageError for no values.
[[nodiscard]] std::size_t index_of_median(const std::vector<double>& values);

}  // namespace waymark::benchmark
