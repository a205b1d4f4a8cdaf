#include <waymark/tools/drive/logs/parts/direction.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::drive {
namespace {

constexpr double kSlowestCourse = 2;  // m/s: a slower one is noise
constexpr double kShortWay = 12;  // m: a turning circle of 10 m bends it by 2.4 rad, less than half a round
constexpr double kShortWayAtEnds = 2;  // m: where only one end has a course

void add(TimeSeries& series, Stamp stamp, double value) {
  series.stamps.push_back(stamp);
  series.values.push_back(value);
}

/// Returns the second difference of angles around reading i; 0 at the ends.
double second_difference(const TimeSeries& angle, std::size_t i) {
  if (i == 0 || i + 1 >= angle.values.size()) return 0;
  return wrap_angle(wrap_angle(angle.values[i + 1] - angle.values[i]) -
                    wrap_angle(angle.values[i] - angle.values[i - 1]));
}

/// Returns the standard deviation of the readings times a weight each, by their second differences.
/// @param weight of reading i: its speed, if the noise grows as 1 / speed
template <typename Weight>
double noise_of(const TimeSeries& angle, Weight weight) {
  constexpr double kMedianOfNormal = 0.6745;
  std::vector<double> sizes;
  for (std::size_t i = 1; i + 1 < angle.values.size(); ++i)
    sizes.push_back(std::abs(second_difference(angle, i)) * weight(i));
  return sizes.empty() ? 0 : upper_median(std::move(sizes)) / (kMedianOfNormal * std::sqrt(6.0));
}

/// @param sigma of reading i, rad
template <typename Sigma>
TimeSeries variance_of_turns(const TimeSeries& angle, Sigma sigma) {
  constexpr double kOfParabola = 0.09;
  TimeSeries result;
  const double interval_s = median_interval_s(angle);
  for (std::size_t i = 0; i < angle.stamps.size(); ++i) {
    const double bend = kOfParabola * second_difference(angle, i);
    const double noise = sigma(i);
    add(result, angle.stamps[i], (noise * noise + bend * bend) / interval_s);
  }
  return result;
}

/// The speed, and the way since its first reading.
class WayTravelled {
 public:
  WayTravelled(const TimeSeries& speed, double gap_s)
      : speed_(speed), silence_s_(longest_silence_s(speed, gap_s)), way_{speed.stamps, {0}} {
    for (std::size_t i = 1; i < speed.stamps.size(); ++i)
      way_.values.push_back(way_.values.back() +
                            0.5 * (std::abs(speed.values[i - 1]) + std::abs(speed.values[i])) *
                                seconds_between(speed.stamps[i - 1], speed.stamps[i]));
  }
  [[nodiscard]] std::optional<double> speed_at(Stamp moment) const {
    return value_at(speed_, moment, silence_s_);
  }
  /// Returns the way at an instant; empty outside the readings and in their silences.
  [[nodiscard]] std::optional<double> at(Stamp moment) const { return value_at(way_, moment, silence_s_); }

 private:
  const TimeSeries& speed_;
  double silence_s_;
  TimeSeries way_;
};

/// Spreads the turn from the last angle to the next one over the way between them, if that is short.
void add_slow_stretch(const WayTravelled& way, Stamp next, double next_angle, double step_s,
                      TimeSeries& angle) {
  const Stamp last = angle.stamps.back();
  const double last_angle = angle.values.back();
  const std::optional<double> begin = way.at(last);
  const std::optional<double> end = way.at(next);
  if (!begin || !end || *end <= *begin || *end - *begin > kShortWay) return;
  TimeSeries between;
  for (Stamp moment = last.later(step_s); moment < next; moment = moment.later(step_s)) {
    const std::optional<double> at = way.at(moment);
    if (!at) return;
    add(between, moment, last_angle + (next_angle - last_angle) * (*at - *begin) / (*end - *begin));
  }
  for (std::size_t i = 0; i < between.stamps.size(); ++i) add(angle, between.stamps[i], between.values[i]);
}

/// Returns the stamps from an end of the angles on, in steps, to where the way becomes longer than little.
std::vector<Stamp> stamps_near_end(const WayTravelled& way, Stamp end, double step_s) {
  std::vector<Stamp> stamps;
  const std::optional<double> begin = way.at(end);
  for (Stamp moment = end.later(step_s); begin; moment = moment.later(step_s)) {
    const std::optional<double> at = way.at(moment);
    if (!at || std::abs(*at - *begin) > kShortWayAtEnds) break;
    stamps.push_back(moment);
  }
  return stamps;
}

/// Carries the first angle back, and the last one on if the log ends there.
void add_ends(const WayTravelled& way, double step_s, bool goes_on, TimeSeries& angle) {
  std::vector<Stamp> before = stamps_near_end(way, angle.stamps.front(), -step_s);
  std::vector<Stamp> after;
  if (!goes_on) after = stamps_near_end(way, angle.stamps.back(), step_s);
  std::reverse(before.begin(), before.end());
  angle.stamps.insert(angle.stamps.begin(), before.begin(), before.end());
  angle.values.insert(angle.values.begin(), before.size(), angle.values.front());
  for (const Stamp stamp : after) add(angle, stamp, angle.values.back());
}

}  // namespace

std::optional<LeapsAtRest> leaps_at_rest(const TimeSeries& heading, const TimeSeries& speed, double gap_s) {
  constexpr double kNoWay = 2.5;   // m: a turning circle of 10 m bends it by 0.5 rad
  constexpr double kSameStop = 3;  // m
  constexpr double kLeap = std::numbers::pi / 4;
  constexpr std::size_t kFewest = 5;
  constexpr std::size_t kFewestBack = 3;
  const WayTravelled way(speed, gap_s);
  LeapsAtRest found;
  std::size_t back = 0;
  double last_leap = 0;
  double last_at = 0;
  for (std::size_t i = 1; i < heading.stamps.size(); ++i) {
    const double leap = wrap_angle(heading.values[i] - heading.values[i - 1]);
    if (std::abs(leap) < kLeap) continue;
    const std::optional<double> from = way.at(heading.stamps[i - 1]);
    const std::optional<double> to = way.at(heading.stamps[i]);
    if (!from || !to || *to - *from > kNoWay) continue;
    ++found.leaps;
    back += leap * last_leap < 0 && *from - last_at < kSameStop;
    found.largest_rad = std::max(found.largest_rad, std::abs(leap));
    last_leap = leap;
    last_at = *to;
  }
  if (found.leaps < kFewest || back < kFewestBack) return std::nullopt;
  return found;
}

Direction turns_of_heading(const TimeSeries& heading) {
  Direction result{unwrapped(heading), {}};
  const double sigma = noise_of(result.angle, [](std::size_t) { return 1.0; });
  result.turn_variance_per_s = variance_of_turns(result.angle, [&](std::size_t) { return sigma; });
  return result;
}

Direction turns_of_course(const TimeSeries& course, const TimeSeries& speed, double gap_s, bool goes_on) {
  const WayTravelled way(speed, gap_s);
  TimeSeries driving;
  std::vector<double> speeds;
  for (std::size_t i = 0; i < course.stamps.size(); ++i) {
    const std::optional<double> v = way.speed_at(course.stamps[i]);
    if (!v || std::abs(*v) < kSlowestCourse) continue;
    add(driving, course.stamps[i], course.values[i] + (*v < 0 ? std::numbers::pi : 0));
    speeds.push_back(std::abs(*v));
  }
  Direction result{{}, {}};
  if (driving.empty()) return result;
  driving = unwrapped(std::move(driving));
  const double across_mps = noise_of(driving, [&](std::size_t i) { return speeds[i]; });
  result.turn_variance_per_s =
      variance_of_turns(driving, [&](std::size_t i) { return across_mps / speeds[i]; });
  const double step_s = median_interval_s(driving);
  const double silence_s = longest_silence_s(driving, gap_s);
  for (std::size_t i = 0; i < driving.stamps.size(); ++i) {
    if (i > 0 && seconds_between(driving.stamps[i - 1], driving.stamps[i]) > silence_s)
      add_slow_stretch(way, driving.stamps[i], driving.values[i], step_s, result.angle);
    add(result.angle, driving.stamps[i], driving.values[i]);
  }
  if (step_s > 0) add_ends(way, step_s, goes_on, result.angle);
  return result;
}

}  // namespace waymark::drive
