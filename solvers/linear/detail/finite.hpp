/// A check that no library does reliably: comparisons with NaN are false, so a NaN pivot passes
/// as positive.
#pragma once

#include <span>

namespace waymark::solvers {

/// Tells whether every number is finite. 0 x is 0 if x is finite, and NaN otherwise.
[[nodiscard]] inline bool all_finite(std::span<const double> values) {
  double sum[4] = {};
  const std::size_t whole = values.size() / 4 * 4;
  for (std::size_t i = 0; i < whole; i += 4) {
    for (std::size_t lane = 0; lane < 4; ++lane) sum[lane] += 0 * values[i + lane];
  }
  for (std::size_t i = whole; i < values.size(); ++i) sum[0] += 0 * values[i];
  return sum[0] + sum[1] + sum[2] + sum[3] == 0;
}

}  // namespace waymark::solvers
