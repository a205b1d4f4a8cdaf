#include <waymark/formats/text/detail/decimal.hpp>

#include <array>
#include <bit>

namespace waymark::formats {
namespace {

constexpr std::ptrdiff_t kMostDigits = 19;  // 10^19 < 2^64

__extension__ using Wide128 = unsigned __int128;

constexpr auto kPowersOfTen = [] {
  std::array<std::uint64_t, kMostDigits + 1> powers{1};
  for (std::size_t k = 1; k < powers.size(); ++k) powers[k] = 10 * powers[k - 1];
  return powers;
}();

/// 2^exponent, -1022 to 1023.
double power_of_two(int exponent) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + exponent) << 52U);
}

/// Returns numerator / denominator, rounded once. Both are shifted until their top bit is set. The
/// quotient of the integers, times 2^63, then has 63 or 64 bits. A double takes 53 of them, and the
/// last bit only has to tell whether there is a remainder.
double divide(std::uint64_t numerator, std::uint64_t denominator) {
  if (numerator == 0) return 0;
  const int up = std::countl_zero(numerator);
  const int down = std::countl_zero(denominator);
  const Wide128 dividend = static_cast<Wide128>(numerator << up) << 63U;
  const std::uint64_t divisor = denominator << down;
  auto quotient = static_cast<std::uint64_t>(dividend / divisor);
  if (static_cast<Wide128>(quotient) * divisor != dividend) quotient |= 1U;
  return static_cast<double>(quotient) * power_of_two(down - up - 63);
}

const char* skip_zeros(const char* place, const char* end) {
  while (place != end && *place == '0') ++place;
  return place;
}

/// Appends the digits from `place` to `number`. Returns the first character that is no digit.
const char* append_digits(const char* place, const char* end, std::uint64_t& number) {
  for (; place != end; ++place) {
    const auto digit = static_cast<unsigned char>(*place - '0');
    if (digit > 9) break;
    number = 10 * number + digit;
  }
  return place;
}

}  // namespace

Decimal read_plain_decimal(const char* begin, const char* end) {
  const bool negative = begin != end && *begin == '-';
  const char* const first = negative ? begin + 1 : begin;
  const char* group = skip_zeros(first, end);
  std::uint64_t number = 0;
  const char* place = append_digits(group, end, number);
  std::ptrdiff_t significant = place - group;
  std::ptrdiff_t decimals = 0;
  bool any_digit = place != first;
  if (place != end && *place == '.') {
    const char* const fraction = place + 1;
    group = significant == 0 ? skip_zeros(fraction, end) : fraction;
    place = append_digits(group, end, number);
    significant += place - group;
    decimals = place - fraction;
    any_digit = any_digit || decimals > 0;
  }
  // With more digits `number` has overflowed, or the power of ten does.
  if (!any_digit || significant > kMostDigits || decimals > kMostDigits) return {};
  const double value = decimals == 0 ? static_cast<double>(number)
                                     : divide(number, kPowersOfTen[static_cast<std::size_t>(decimals)]);
  return {negative ? -value : value, place};
}

}  // namespace waymark::formats
