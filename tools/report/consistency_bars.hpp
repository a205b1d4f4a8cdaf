/// Compares stated with actual errors in figures: mean NEES and coverage, each with the range for
/// consistent covariances.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/drawing/figure/figure.hpp>
#include <waymark/tools/evaluation/numbers/consistency.hpp>

namespace waymark::report {

struct StatedErrors {
  std::string label;  ///< name of its row
  evaluation::ConsistencyStatistics statistics;
};

/// Returns two bar figures with a row for each estimate that has a NEES: ids PREFIX-nees and
/// PREFIX-coverage. The bracket of each row is the range in which a consistent covariance puts the
/// number on 95 of 100 drives. Empty if no estimate has a NEES.
[[nodiscard]] std::vector<drawing::Figure> consistency_bars(const std::string& prefix,
                                                            const std::vector<StatedErrors>& rows);

/// Returns "consistent", "too small" or "too large": the judgement of the mean NEES on the stated
/// errors. "-" if there is none.
[[nodiscard]] std::string consistency_verdict(const evaluation::ConsistencyStatistics& statistics);

}  // namespace waymark::report
