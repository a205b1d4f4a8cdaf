#include <waymark/formats/text/stamp_text.hpp>

#include <charconv>
#include <cstdint>
#include <limits>

#include <fmt/format.h>

#include <waymark/formats/text/detail/characters.hpp>

namespace waymark::formats {
namespace {

/// The parts of a decimal number: value = digits * 10^exponent, digits without leading zeros.
struct DigitsAndExponent {
  bool negative = false;
  std::string digits;
  int exponent = 0;
};

/// Reads the exponent after 'e'. Empty if it is none or far too large.
std::optional<int> read_exponent(std::string_view text) {
  // from_chars accepts a minus, but no plus.
  if (text.size() > 1 && text.front() == '+' && is_digit(text[1])) text.remove_prefix(1);
  int exponent = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), exponent);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if (exponent < -1000 || exponent > 1000) return std::nullopt;
  return exponent;
}

std::optional<DigitsAndExponent> read_decimal(std::string_view text) {
  DigitsAndExponent number;
  if (!text.empty() && (text.front() == '+' || text.front() == '-')) {
    number.negative = text.front() == '-';
    text.remove_prefix(1);
  }
  bool any_digit = false;
  bool after_point = false;
  while (!text.empty() && (is_digit(text.front()) || (text.front() == '.' && !after_point))) {
    if (text.front() == '.') {
      after_point = true;
    } else {
      any_digit = true;
      if (!number.digits.empty() || text.front() != '0') number.digits += text.front();
      if (after_point) --number.exponent;
    }
    text.remove_prefix(1);
  }
  if (!any_digit) return std::nullopt;
  if (text.empty()) return number;
  if (text.front() != 'e' && text.front() != 'E') return std::nullopt;
  const std::optional<int> exponent = read_exponent(text.substr(1));
  if (!exponent) return std::nullopt;
  number.exponent += *exponent;
  return number;
}

/// Reads an integer from digits; no digits mean 0. Empty if it overflows 64 bits.
std::optional<std::uint64_t> read_integer(std::string_view digits) {
  std::uint64_t value = 0;
  if (digits.empty()) return value;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc()) return std::nullopt;
  return value;
}

/// Returns digits * 10^exponent as an integer, rounded half up. Empty if it overflows 64 bits.
std::optional<std::uint64_t> to_integer(std::string_view digits, int exponent) {
  if (digits.empty()) return 0;
  if (exponent >= 0) {
    const auto zeros = static_cast<std::size_t>(exponent);
    if (digits.size() + zeros > 20) return std::nullopt;
    return read_integer(std::string(digits) + std::string(zeros, '0'));
  }
  const auto dropped = static_cast<std::size_t>(-exponent);
  if (dropped > digits.size()) return 0;
  const std::size_t kept = digits.size() - dropped;
  const std::optional<std::uint64_t> value = read_integer(digits.substr(0, kept));
  // The value is far outside the range of a stamp, or the one value that rounding up would wrap.
  if (!value || *value == std::numeric_limits<std::uint64_t>::max()) return std::nullopt;
  return digits[kept] >= '5' ? *value + 1 : *value;
}

/// Reads the usual form in logs: digits, a point, and at most nine decimals. It needs no rounding
/// and cannot overflow.
/// @return empty for everything else; the general function above reads that
std::optional<Stamp> read_plain(std::string_view text) {
  constexpr std::int64_t kLargest = std::numeric_limits<std::int64_t>::max() / 1'000'000'000 - 1;
  const bool negative = !text.empty() && text.front() == '-';
  const std::size_t first = negative ? 1 : 0;
  std::size_t at = first;
  std::int64_t seconds = 0;
  for (; at < text.size() && is_digit(text[at]); ++at) {
    if (at - first == 10) return std::nullopt;
    seconds = 10 * seconds + (text[at] - '0');
  }
  if (at == first || seconds > kLargest) return std::nullopt;
  std::int64_t nanoseconds = 0;
  if (at < text.size()) {
    if (text[at] != '.' || text.size() - at > 10) return std::nullopt;
    std::int64_t unit = 1'000'000'000;
    while (++at < text.size()) {
      if (!is_digit(text[at])) return std::nullopt;
      unit /= 10;
      nanoseconds = 10 * nanoseconds + (text[at] - '0');
    }
    nanoseconds *= unit;
  }
  nanoseconds += seconds * 1'000'000'000;
  return Stamp{negative ? -nanoseconds : nanoseconds};
}

}  // namespace

std::string decimal_seconds(Stamp stamp) {
  const bool negative = stamp.nanoseconds < 0;
  const auto bits = static_cast<std::uint64_t>(stamp.nanoseconds);
  const std::uint64_t magnitude = negative ? 0 - bits : bits;  // also right for the smallest int64
  return fmt::format("{}{}.{:09}", negative ? "-" : "", magnitude / 1'000'000'000, magnitude % 1'000'000'000);
}

std::optional<Stamp> stamp_from_decimal_seconds(std::string_view text) {
  if (const std::optional<Stamp> plain = read_plain(text)) return plain;
  const std::optional<DigitsAndExponent> number = read_decimal(text);
  if (!number) return std::nullopt;
  const std::optional<std::uint64_t> magnitude = to_integer(number->digits, number->exponent + 9);
  if (!magnitude || *magnitude > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
    return std::nullopt;
  const auto nanoseconds = static_cast<std::int64_t>(*magnitude);
  return Stamp{number->negative ? -nanoseconds : nanoseconds};
}

}  // namespace waymark::formats
