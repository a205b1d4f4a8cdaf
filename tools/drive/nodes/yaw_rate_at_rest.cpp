#include <waymark/tools/drive/nodes/yaw_rate_at_rest.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include <waymark/core/base/detail/median.hpp>

namespace waymark::drive {
namespace {

constexpr double kTurnWindow_s = 2;

/// Returns what the yaw rate usually reads at rest; 0 if the vehicle hardly stands. A drive may turn for most of
/// its only stop, but it goes straight more than it turns: readings near the median of the drive count.
double usual_at_rest(std::span<const OdometrySample> odometry) {
  constexpr double kMoves_mps = 0.5;
  constexpr double kNear_radps = 0.02;
  constexpr double kLargestBias_radps = 0.05;  // 3 deg/s
  std::vector<double> moving;
  std::vector<double> resting;
  for (const OdometrySample& sample : odometry) {
    if (is_at_rest(sample)) resting.push_back(sample.yaw_rate_radps);
    if (std::abs(sample.speed_mps) > kMoves_mps) moving.push_back(sample.yaw_rate_radps);
  }
  if (resting.empty()) return 0;
  std::vector<double> near;
  if (!moving.empty()) {
    const double straight = upper_median(std::move(moving));
    std::copy_if(resting.begin(), resting.end(), std::back_inserter(near),
                 [&](double reading) { return std::abs(reading - straight) < kNear_radps; });
  }
  const double usual = upper_median(near.size() * 10 < resting.size() ? std::move(resting) : std::move(near));
  return std::clamp(usual, -kLargestBias_radps, kLargestBias_radps);
}

/// Marks the samples of one stop at which the mean yaw rate over two seconds is not the usual one.
void mark_turns(double usual, double clear, std::span<OdometrySample> stop) {
  std::vector<double> angle(stop.size(), 0);
  for (std::size_t i = 1; i < stop.size(); ++i)
    angle[i] = angle[i - 1] + (0.5 * (stop[i - 1].yaw_rate_radps + stop[i].yaw_rate_radps) - usual) *
                                  seconds_between(stop[i - 1].stamp, stop[i].stamp);
  std::size_t marked = 0;
  for (std::size_t first = 0, last = 0; first < stop.size(); ++first) {
    while (last < stop.size() && seconds_between(stop[first].stamp, stop[last].stamp) < kTurnWindow_s) ++last;
    if (last == stop.size()) return;
    const double duration = seconds_between(stop[first].stamp, stop[last].stamp);
    if (std::abs(angle[last] - angle[first]) <= clear * duration) continue;
    for (marked = std::max(marked, first); marked <= last; ++marked) stop[marked].turns_on_spot = true;
  }
}

}  // namespace

bool is_at_rest(const OdometrySample& sample) {
  constexpr double kStands_mps = 0.05;
  const Interval motion{.speed_mps = sample.speed_mps,
                        .yaw_rate_radps = sample.yaw_rate_radps,
                        .turns_on_spot = sample.turns_on_spot};
  return motion.stands(kStands_mps) && !sample.assumed;
}

YawRateAtRest yaw_rate_at_rest(std::span<const OdometrySample> odometry, bool stated_derived) {
  YawRateAtRest rest{.stated_derived = stated_derived};
  double squares = 0;
  std::size_t count = 0;
  for (std::size_t i = 1; i < odometry.size(); ++i) {
    if (!is_at_rest(odometry[i - 1]) || !is_at_rest(odometry[i])) continue;
    rest.seconds += seconds_between(odometry[i - 1].stamp, odometry[i].stamp);
    squares += std::pow(odometry[i].yaw_rate_radps - odometry[i - 1].yaw_rate_radps, 2);
    ++count;
  }
  if (count == 0) return rest;
  const double variance = 0.5 * squares / static_cast<double>(count);  // of one reading
  rest.variance_per_s = variance * rest.seconds / static_cast<double>(count);
  return rest;
}

void mark_turns_on_spot(std::span<OdometrySample> odometry) {
  constexpr double kClear_radps = 0.015;
  constexpr double kDeviations = 5;
  const double noise = std::sqrt(yaw_rate_at_rest(odometry).variance_per_s / kTurnWindow_s);
  const double clear = std::max(kClear_radps, kDeviations * noise);
  const double usual = usual_at_rest(odometry);
  for (auto begin = odometry.begin(); begin != odometry.end();) {
    begin = std::find_if(begin, odometry.end(), is_at_rest);
    const auto end = std::find_if_not(begin, odometry.end(), is_at_rest);
    mark_turns(usual, clear, {begin, end});
    begin = end;
  }
}

}  // namespace waymark::drive
