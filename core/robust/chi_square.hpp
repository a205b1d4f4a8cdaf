/// The chi-square distribution: how large a squared error may be before it is no noise.
#pragma once

namespace waymark {

/// P(chi2 > x) with `freedom` >= 1 degrees of freedom, x >= 0. Recurrence over the degrees of freedom from
/// the closed forms for 1 and 2 (Abramowitz, Stegun, 26.4.4 and 26.4.5).
[[nodiscard]] double chi_square_tail(double x, int freedom);

/// The x with P(chi2 <= x) = probability, 0 < probability < 1. Three degrees of freedom, 0.9999: 21.108.
[[nodiscard]] double chi_square_quantile(double probability, int freedom);

}  // namespace waymark
