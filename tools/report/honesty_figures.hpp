/// Stated against actual error as figures: mean NEES and coverage, with what an honest covariance may show.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/drawing/figure/figure.hpp>
#include <waymark/tools/evaluation/numbers/consistency.hpp>

namespace waymark::report {

struct StatedErrors {
  std::string label;  ///< of its row
  evaluation::ConsistencyStatistics statistics;
};

/// Two figures of bars, a row for each estimate that has a NEES: ids PREFIX-nees and PREFIX-coverage. The
/// bracket of each row is where an honest covariance leaves the number on 95 of 100 drives. Empty where no
/// estimate has one.
[[nodiscard]] std::vector<drawing::Figure> honesty_figures(const std::string& prefix,
                                                           const std::vector<StatedErrors>& rows);

/// "honest", "too small" or "too large": what the mean NEES says of the stated errors; "-" without one.
[[nodiscard]] std::string honesty(const evaluation::ConsistencyStatistics& statistics);

}  // namespace waymark::report
