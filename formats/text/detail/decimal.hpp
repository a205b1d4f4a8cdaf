/// Plain decimal numbers, "-1.0707886032319998": what graph files consist of.
#pragma once

#include <cstdint>

namespace waymark::formats {

/// A number and where it ends; `end` is null where this function does not know the number.
struct Decimal {
  double value = 0;
  const char* end = nullptr;
};

/// Reads an optional minus, digits, and optionally a point with digits behind it; whatever follows is not
/// looked at. Rounded to nearest like std::from_chars, in half its time. Numbers that are not so simple (an
/// exponent, more than 19 significant digits or decimals, no digit at all) are left to that.
[[nodiscard]] Decimal read_plain_decimal(const char* begin, const char* end);

}  // namespace waymark::formats
