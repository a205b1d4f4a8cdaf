#include <algorithm>
#include <cmath>
#include <limits>

#include <waymark/tools/drawing/page/rounded_column.hpp>

namespace waymark::drawing {
namespace {

constexpr double kFineness = 1e-7;
// whole numbers are exact up to here, also in the script of the page
constexpr double kLargestExact = 4e15;

}  // namespace

double rounding_step(const std::vector<double>& values) {
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

RoundedColumn rounded(const std::vector<double>& values) {
  RoundedColumn column{.step = rounding_step(values)};
  column.differences.reserve(values.size());
  std::int64_t before = 0;
  for (const double value : values) {
    if (!std::isfinite(value)) {
      column.differences.emplace_back();
      continue;
    }
    const auto steps = static_cast<std::int64_t>(std::round(value / column.step));
    column.differences.emplace_back(steps - before);
    before = steps;
  }
  return column;
}

}  // namespace waymark::drawing
