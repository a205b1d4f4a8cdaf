/// Plain decimal numbers like "-1.0707886032319998", as graph files hold them.
#pragma once

#include <cstdint>

namespace waymark::formats {

/// A number and its end; `end` is null if the text is not a plain decimal.
struct Decimal {
  double value = 0;
  const char* end = nullptr;
};

/// Reads an optional minus, digits, and optionally a point with digits after it. The text behind
/// the number is ignored. The result is rounded to nearest like that of std::from_chars, in half
/// its time. Other numbers are left to std::from_chars: those with an exponent, with more than 19
/// significant digits or decimals, or without digits.
[[nodiscard]] Decimal read_plain_decimal(const char* begin, const char* end);

}  // namespace waymark::formats
