/// The chi-square distribution. It tells how large a squared error may be and still be noise.
#pragma once

#include <waymark/core/base/export.hpp>

namespace WAYMARK_EXPORT waymark {

/// Returns P(chi2 > x) with `freedom` >= 1 degrees of freedom, x >= 0. It uses the recurrence
/// over the degrees of freedom from the closed forms for 1 and 2 (Abramowitz, Stegun, 26.4.4
/// and 26.4.5).
[[nodiscard]] double chi_square_tail(double x, int freedom);

/// Returns the x with P(chi2 <= x) = probability, 0 < probability < 1. For three degrees of freedom
/// and 0.9999 it is 21.108.
[[nodiscard]] double chi_square_quantile(double probability, int freedom);

}  // namespace waymark
