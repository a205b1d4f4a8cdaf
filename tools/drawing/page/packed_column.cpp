#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <fmt/format.h>

#include <waymark/tools/drawing/page/packed_column.hpp>

namespace waymark::drawing {
namespace {

constexpr double kFineness = 1e-7;
// whole numbers are exact up to here, also in the script of the page
constexpr double kLargestExact = 4e15;

std::string base64(const std::vector<std::uint8_t>& bytes) {
  static constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) -> std::uint32_t {
      return i + k < bytes.size() ? bytes[i + k] : 0U;
    };
    const std::uint32_t triple = (byte(0) << 16U) | (byte(1) << 8U) | byte(2);
    for (unsigned digit = 0; digit < 4; ++digit) {
      const bool padding = i + digit > bytes.size();
      text += padding ? '=' : kDigits[(triple >> (18U - 6U * digit)) & 63U];
    }
  }
  return text;
}

void append_varint(std::uint64_t value, std::vector<std::uint8_t>& bytes) {
  while (value >= 128) {
    bytes.push_back(static_cast<std::uint8_t>((value & 127U) | 128U));
    value >>= 7U;
  }
  bytes.push_back(static_cast<std::uint8_t>(value));
}

}  // namespace

double packing_step(const std::vector<double>& values) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  bool whole = true;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
    whole = whole && value == std::round(value);
  }
  if (!(low <= high) || (whole && std::max(-low, high) < kLargestExact)) return 1;
  const double largest = std::max(std::abs(low), std::abs(high));
  const double extent = high > low ? high - low : largest;
  return std::pow(10.0, std::floor(std::log10(std::max(kFineness * extent, largest / kLargestExact))));
}

std::string pack(const std::vector<double>& values) {
  const double step = packing_step(values);
  std::vector<std::uint8_t> bytes;
  bytes.reserve(2 * values.size());
  std::int64_t before = 0;
  for (const double value : values) {
    if (!std::isfinite(value)) {
      bytes.push_back(0);
      continue;
    }
    const auto steps = static_cast<std::int64_t>(std::round(value / step));
    const std::int64_t difference = steps - before;
    before = steps;
    const auto zigzag =
        (static_cast<std::uint64_t>(difference) << 1U) ^ static_cast<std::uint64_t>(difference >> 63);
    append_varint(zigzag + 1, bytes);
  }
  return fmt::format("{}:{}", step, base64(bytes));
}

}  // namespace waymark::drawing
