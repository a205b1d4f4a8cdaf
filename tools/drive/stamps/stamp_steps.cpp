#include <waymark/tools/drive/stamps/stamp_steps.hpp>

#include <algorithm>
#include <cmath>

#include <waymark/tools/drive/stamps/steps_back.hpp>

namespace waymark::drive {

std::vector<StampStep> find_stamp_steps(std::span<const Stamp> stamps) {
  constexpr double kLeast_s = 0.3;
  constexpr double kFewestIntervals = 5;
  constexpr std::size_t kMostSteps = 10;
  const double usual_s = usual_interval_s(stamps);
  const double least_s = std::max(kLeast_s, kFewestIntervals * usual_s);
  std::vector<StampStep> steps;
  for (std::size_t row = 1; row < stamps.size(); ++row) {
    const double by_s = seconds_between(stamps[row - 1], stamps[row]) - usual_s;
    if (std::abs(by_s) > least_s) steps.push_back({row, stamps[row - 1], by_s});
  }
  if (steps.size() > kMostSteps) steps.clear();
  return steps;
}

}  // namespace waymark::drive
