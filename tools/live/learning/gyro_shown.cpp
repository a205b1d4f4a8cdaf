#include <waymark/tools/live/learning/gyro_shown.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/tools/drive/nodes/yaw_rate_at_rest.hpp>

namespace waymark::live {
namespace {

/// The reading of a gyro in a stop.
struct BiasAtStop {
  Stamp middle;
  double radps = 0;
  double seconds = 0;
};

std::vector<BiasAtStop> biases_at_stops(const std::deque<OdometrySample>& odometry) {
  constexpr double kShortest_s = 2;
  std::vector<BiasAtStop> stops;
  for (auto begin = odometry.begin(); begin != odometry.end();) {
    begin = std::find_if(begin, odometry.end(), drive::is_at_rest);
    const auto end = std::find_if_not(begin, odometry.end(), drive::is_at_rest);
    double sum = 0;
    for (auto at = begin; at != end; ++at) sum += at->yaw_rate_radps;
    const double seconds = begin == end ? 0 : seconds_between(begin->stamp, std::prev(end)->stamp);
    if (seconds >= kShortest_s)
      stops.push_back({begin->stamp.later(0.5 * seconds), sum / static_cast<double>(end - begin), seconds});
    begin = end;
  }
  return stops;
}

}  // namespace

double white_noise_of(const std::deque<OdometrySample>& odometry) {
  constexpr std::size_t kFewest = 100;
  constexpr double kLongest_s = 0.1;
  constexpr double kMedianOfSquare = 0.455;  // chi-square with one degree of freedom
  constexpr double kSecondDifference = 6;    // variances of a reading
  std::vector<double> squares;
  std::vector<double> steps_s;
  for (std::size_t i = 2; i < odometry.size(); ++i) {
    const double step_s = seconds_between(odometry[i - 1].stamp, odometry[i].stamp);
    if (step_s > kLongest_s) continue;
    const double difference =
        odometry[i].yaw_rate_radps - 2 * odometry[i - 1].yaw_rate_radps + odometry[i - 2].yaw_rate_radps;
    squares.push_back(difference * difference);
    steps_s.push_back(step_s);
  }
  if (squares.size() < kFewest) return 0;
  const double variance = upper_median(std::move(squares)) / (kMedianOfSquare * kSecondDifference);
  return variance * upper_median(std::move(steps_s));
}

// Maximum likelihood of the steps of a random walk between stops, beside so many steps of the usual one.
double bias_walk_of(const std::deque<OdometrySample>& odometry) {
  constexpr double kUsual = 2e-5;
  constexpr double kAtFirst = 1e-3;  // the search comes down from there: poor readings count less and less
  constexpr double kUsualSteps = 2;
  constexpr double kLargestStep_radps = 0.015;  // more is a turn on the spot
  constexpr int kRounds = 20;
  const double white = white_noise_of(odometry);
  if (white == 0) return kUsual;  // what stops tell of the bias is not known
  const std::vector<BiasAtStop> stops = biases_at_stops(odometry);
  double variance = kAtFirst * kAtFirst;
  for (int round = 0; round < kRounds; ++round) {
    double sum = kUsualSteps * kUsual * kUsual;
    double weights = kUsualSteps;
    for (std::size_t i = 1; i < stops.size(); ++i) {
      const double step = stops[i].radps - stops[i - 1].radps;
      if (std::abs(step) > kLargestStep_radps) continue;
      const double apart_s = seconds_between(stops[i - 1].middle, stops[i].middle);
      const double noise = white * (1 / stops[i - 1].seconds + 1 / stops[i].seconds) / apart_s;
      const double weight = std::pow(variance / (variance + noise), 2);
      sum += weight * std::max(0.0, step * step / apart_s - noise);
      weights += weight;
    }
    variance = sum / weights;
  }
  return std::sqrt(variance);
}

}  // namespace waymark::live
