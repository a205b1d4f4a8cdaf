#include <waymark/tools/drive/comparison/chords.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::drive {
namespace {

/// Returns the heading along [first, last], weighted with time.
double mean_heading(const ReckonedFixes& receiver, std::size_t first, std::size_t last) {
  double sum = 0;
  for (std::size_t i = first; i < last; ++i) {
    const double dt = seconds_between(receiver.fixes[i].stamp, receiver.fixes[i + 1].stamp);
    sum += 0.5 * (receiver.antenna[i][2] + receiver.antenna[i + 1][2]) * dt;
  }
  return sum / seconds_between(receiver.fixes[first].stamp, receiver.fixes[last].stamp);
}

/// Returns the mean of what a function leaves of the turns. A single wrong fix counts at most 1 rad.
template <typename LeftOf>
double mean_left(std::span<const TurnPair> turns, LeftOf left_of) {
  double sum = 0;
  for (const TurnPair& pair : turns) sum += std::min(1.0, std::abs(left_of(pair)));
  return sum / static_cast<double>(turns.size());
}

/// Returns the mean difference of the turns with a factor.
double difference_with(double factor, std::span<const TurnPair> turns) {
  return mean_left(
      turns, [&](const TurnPair& pair) { return wrap_angle(pair.gnss_rad - factor * pair.odometry_rad); });
}

/// Returns the same of the chords themselves, which have a factor of 1.
double difference_of_chords(std::span<const TurnPair> turns) {
  return mean_left(turns, [](const TurnPair& pair) { return pair.apart_rad; });
}

/// By how much the odometry turns more from one chord to the next, and the time and the way of that.
struct TurnApart {
  double turn_rad = 0;
  double duration_s = 0;
  double way_m = 0;
};

/// A constant rate of such turns, and what it leaves of them in the median.
struct Rate {
  Median rate;
  double left_rad = 0;
};

/// @param of what the rate is by
Rate rate_of(std::span<const TurnApart> turns, double TurnApart::*of) {
  std::vector<double> rates;
  for (const TurnApart& turn : turns) rates.push_back(turn.turn_rad / turn.*of);
  const Median rate = median_with_sigma(std::move(rates));
  std::vector<double> left;
  for (const TurnApart& turn : turns) left.push_back(std::abs(turn.turn_rad - rate.value * turn.*of));
  return {rate, upper_median(std::move(left))};
}

}  // namespace

ReckonedFixes of_receiver(std::span<const Fix> fixes, std::span<const Eigen::Vector3d> antenna, int source) {
  ReckonedFixes receiver;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    const bool same_time = !receiver.fixes.empty() && receiver.fixes.back().stamp == fixes[i].stamp;
    if (fixes[i].source != source || same_time) continue;
    receiver.fixes.push_back(fixes[i]);
    receiver.antenna.push_back(antenna[i]);
    receiver.place.push_back(i);
  }
  return receiver;
}

ChordPair chord_between(const ReckonedFixes& receiver, std::size_t first, std::size_t last) {
  return {.gnss = receiver.fixes[last].position - receiver.fixes[first].position,
          .odometry = receiver.antenna[last].head<2>() - receiver.antenna[first].head<2>(),
          .duration_s = seconds_between(receiver.fixes[first].stamp, receiver.fixes[last].stamp),
          .middle_s = 0.5 * (seconds_between(receiver.fixes.front().stamp, receiver.fixes[first].stamp) +
                             seconds_between(receiver.fixes.front().stamp, receiver.fixes[last].stamp)),
          .turn_rad = receiver.antenna[last][2] - receiver.antenna[first][2]};
}

std::vector<ChordPair> chords_of(const ReckonedFixes& receiver, double longest_s,
                                 const std::function<bool(const ChordPair&)>& is_complete) {
  std::vector<ChordPair> chords;
  std::size_t first = 0;
  bool unbroken = false;
  for (std::size_t i = 1; i < receiver.fixes.size(); ++i) {
    while (first < i && seconds_between(receiver.fixes[first].stamp, receiver.fixes[i].stamp) > longest_s) {
      ++first;
      unbroken = false;
    }
    if (first == i) continue;
    ChordPair next = chord_between(receiver, first, i);
    if (!is_complete(next)) continue;
    next.heading_rad = mean_heading(receiver, first, i);
    next.follows = unbroken;
    chords.push_back(next);
    unbroken = true;
    first = i;
  }
  return chords;
}

double turns_apart(const ChordPair& one, const ChordPair& next) {
  return wrap_angle(angle_between(one.odometry, next.odometry) - angle_between(one.gnss, next.gnss));
}

YawBias bias_of(std::span<const ChordPair> chords) {
  constexpr std::size_t kFewest = 10;
  constexpr double kLeast_m = 1e-3;
  std::vector<TurnApart> turns;
  for (std::size_t i = 1; i < chords.size(); ++i) {
    const ChordPair& one = chords[i - 1];
    const ChordPair& next = chords[i];
    if (!next.follows) continue;
    turns.push_back({turns_apart(one, next), 0.5 * (one.duration_s + next.duration_s),
                     std::max(kLeast_m, 0.5 * (one.odometry.norm() + next.odometry.norm()))});
  }
  if (turns.size() < kFewest) return {};
  const Rate of_time = rate_of(turns, &TurnApart::duration_s);
  const Rate of_way = rate_of(turns, &TurnApart::way_m);
  const auto sigmas = [](const Median& rate) { return std::abs(rate.value) / rate.sigma; };
  if (of_way.left_rad < of_time.left_rad) return {.radpm = of_way.rate.value, .sigmas = sigmas(of_way.rate)};
  return {.radps = of_time.rate.value, .sigmas = sigmas(of_time.rate)};
}

ReckonedFixes without_error(ReckonedFixes receiver, const YawError& error) {
  const std::vector<Eigen::Vector3d> bent = receiver.antenna;
  constexpr double kAtRest_mps = 0.05;
  double way_m = 0;
  double moving_s = 0;  // an odometry that stands does not turn
  double turned = 0;    // at the previous fix
  for (std::size_t i = 0; i < bent.size(); ++i) {
    const Eigen::Vector2d step = bent[i].head<2>() - bent[i == 0 ? 0 : i - 1].head<2>();
    const bool is_forward = rotate(-bent[i][2], step).x() >= 0;
    way_m += is_forward ? step.norm() : -step.norm();
    const double step_s = i == 0 ? 0 : seconds_between(receiver.fixes[i - 1].stamp, receiver.fixes[i].stamp);
    if (step.norm() > kAtRest_mps * step_s) moving_s += step_s;
    const double turns =
        bent[i][2] * (1 / error.factor - 1) - error.bias_radps * moving_s - error.bias_radpm * way_m;
    if (i > 0)
      receiver.antenna[i].head<2>() =
          receiver.antenna[i - 1].head<2>() + rotate(0.5 * (turned + turns), step);
    receiver.antenna[i][2] = bent[i][2] + turns;
    turned = turns;
  }
  return receiver;
}

std::vector<TurnPair> turns_of(std::span<const ChordPair> chords) {
  std::vector<TurnPair> turns;
  for (std::size_t i = 1; i < chords.size(); ++i) {
    if (!chords[i].follows) continue;
    turns.push_back({angle_between(chords[i - 1].gnss, chords[i].gnss),
                     chords[i].heading_rad - chords[i - 1].heading_rad,
                     turns_apart(chords[i - 1], chords[i])});
  }
  return turns;
}

std::optional<double> factor_of_turns(std::span<const TurnPair> turns) {
  if (turns.empty()) return std::nullopt;
  constexpr int kSteps = 300;  // of 3 % each, from 0.01 to 100
  double best = 1;
  double least = std::min(difference_with(1, turns), difference_of_chords(turns));
  const double enough = 0.5 * std::min(least, difference_with(0, turns));
  for (int step = 0; step <= kSteps; ++step) {
    const double size = 0.01 * std::pow(1e4, static_cast<double>(step) / kSteps);
    for (const double factor : {size, -size}) {
      const double difference = difference_with(factor, turns);
      if (difference >= least) continue;
      least = difference;
      best = factor;
    }
  }
  if (least > enough) return std::nullopt;
  return best;
}

Median median_with_sigma(std::vector<double> values) {
  Median median;
  median.value = upper_median(values);
  const auto count = static_cast<double>(values.size());
  for (double& value : values) value = std::abs(value - median.value);
  median.spread = 1.4826 * upper_median(values);  // of a normal distribution
  median.sigma = std::sqrt(std::numbers::pi / 2) * median.spread / std::sqrt(count);
  return median;
}

}  // namespace waymark::drive
