#include <waymark/tools/drive/nodes/yaw_rate_at_rest.hpp>

#include <cmath>

namespace waymark::drive {

YawRateAtRest yaw_rate_at_rest(std::span<const OdometrySample> odometry, bool stated_derived) {
  constexpr double kStands_mps = 0.05;
  const auto stands = [](const OdometrySample& sample) {
    return Interval{sample.speed_mps, sample.yaw_rate_radps}.stands(kStands_mps) && !sample.assumed;
  };
  YawRateAtRest rest{.stated_derived = stated_derived};
  double squares = 0;
  std::size_t count = 0;
  for (std::size_t i = 1; i < odometry.size(); ++i) {
    if (!stands(odometry[i - 1]) || !stands(odometry[i])) continue;
    rest.seconds += seconds_between(odometry[i - 1].stamp, odometry[i].stamp);
    squares += std::pow(odometry[i].yaw_rate_radps - odometry[i - 1].yaw_rate_radps, 2);
    ++count;
  }
  if (count == 0) return rest;
  const double variance = 0.5 * squares / static_cast<double>(count);  // of one reading
  rest.variance_per_s = variance * rest.seconds / static_cast<double>(count);
  return rest;
}

}  // namespace waymark::drive
