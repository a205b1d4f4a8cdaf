/// Numbers as text for people; "-" stands for an undefined number.
#pragma once

#include <string>

namespace waymark::text {

/// Returns the number with so many decimals.
[[nodiscard]] std::string decimals(double value, int digits);
/// Returns the number with four significant digits.
[[nodiscard]] std::string readable(double value);

}  // namespace waymark::text
