#include <waymark/formats/logs/fix_quality.hpp>

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace waymark::formats {

UsualSigma usual_sigma(FixQuality quality) {
  switch (quality) {
    case FixQuality::fixed:
      return {0.02, false};
    case FixQuality::floating:
      return {0.4, false};
    case FixQuality::single:
      return {3, true};
    case FixQuality::differential:
      return {1.5, true};
    case FixQuality::dead_reckoned:
      return {10, true};
    case FixQuality::unknown:
    case FixQuality::manual:
    case FixQuality::simulated:
      break;
  }
  return {};
}

std::string quality_counts(const std::map<FixQuality, std::size_t>& counts) {
  std::vector<std::pair<FixQuality, std::size_t>> ordered(counts.begin(), counts.end());
  std::stable_sort(ordered.begin(), ordered.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string text;
  for (const auto& [quality, count] : ordered)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, to_string(quality));
  return text;
}

}  // namespace waymark::formats
