/// Rounds numbers to short text, because a page may hold a hundred thousand of them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace waymark::drawing {

/// A column of numbers in whole steps. The sum of the differences up to a number is that number, in
/// steps. All sums and differences are below 2^53, so a script holds them exactly.
struct RoundedColumn {
  double step = 1;
  std::vector<std::optional<std::int64_t>> differences{};  ///< empty if the number is not finite
};

/// Returns the step to which `rounded` rounds a column. It is a power of ten and at most 1e-7 of
/// the extent of the column (a millimetre in ten kilometres). For whole numbers it is 1.
[[nodiscard]] double rounding_step(const std::vector<double>& values);

[[nodiscard]] RoundedColumn rounded(const std::vector<double>& values);

}  // namespace waymark::drawing
