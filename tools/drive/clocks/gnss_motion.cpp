#include <waymark/tools/drive/clocks/gnss_motion.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <waymark/tools/drive/logs/time_series.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::drive {
namespace {

constexpr double kSlow = 3;             // m/s: at lower speeds a course means little
constexpr double kFastest = 70;         // m/s: a higher speed between fixes is a jump
constexpr double kShortestChord = 2;    // m
constexpr double kLongestInterval = 5;  // s between fixes that are compared
constexpr double kDopplerWindow = 0.2;  // s around the stamp of a Doppler speed

Stamp halfway(Stamp a, Stamp b) {
  return {a.nanoseconds + (b.nanoseconds - a.nanoseconds) / 2};
}

bool neighbours(const Fix& a, const Fix& b) {
  const double dt = seconds_between(a.stamp, b.stamp);
  return dt > 0 && dt <= kLongestInterval;
}

/// Keeps fixes a second apart, at the rate of most receivers: chords between closer ones are mostly noise.
std::vector<const Fix*> spaced(const std::vector<const Fix*>& fixes) {
  constexpr double kApart = 0.9;  // s
  std::vector<const Fix*> kept;
  for (const Fix* fix : fixes)
    if (kept.empty() || seconds_between(kept.back()->stamp, fix->stamp) >= kApart) kept.push_back(fix);
  return kept;
}

/// Adds the turn between two directions of travel.
void add_turn(GnssMotion& to, Stamp from, double from_angle, Stamp until, double until_angle) {
  const double dt = seconds_between(from, until);
  if (dt <= 0 || dt > kLongestInterval) return;
  to.stretches.push_back({from, until, wrap_angle(until_angle - from_angle) / dt});
}

}  // namespace

std::vector<const Fix*> of_one_receiver(const std::vector<Fix>& fixes) {
  std::vector<std::vector<const Fix*>> by_source;
  for (const Fix& fix : fixes) {
    const auto source = static_cast<std::size_t>(fix.source);
    if (by_source.size() <= source) by_source.resize(source + 1);
    by_source[source].push_back(&fix);
  }
  return *std::max_element(by_source.begin(), by_source.end(),
                           [](const auto& a, const auto& b) { return a.size() < b.size(); });
}

namespace {

/// Distances between fixes over their time.
std::vector<Stretch> chord_speeds(const std::vector<const Fix*>& fixes) {
  std::vector<Stretch> stretches;
  const std::vector<const Fix*> apart = spaced(fixes);
  for (std::size_t i = 1; i < apart.size(); ++i) {
    if (!neighbours(*apart[i - 1], *apart[i])) continue;
    const double speed = (apart[i]->position - apart[i - 1]->position).norm() /
                         seconds_between(apart[i - 1]->stamp, apart[i]->stamp) / apart[i]->grid_scale;
    if (speed < kFastest) stretches.push_back({apart[i - 1]->stamp, apart[i]->stamp, speed});
  }
  return stretches;
}

GnssMotion gnss_speeds(const std::vector<const Fix*>& fixes, bool lags) {
  const auto given =
      std::count_if(fixes.begin(), fixes.end(), [](const Fix* f) { return f->speed_mps.has_value(); });
  if (lags || 2 * static_cast<std::size_t>(given) <= fixes.size())
    return {"distance between fixes", chord_speeds(fixes)};
  GnssMotion result{"receiver's speed", {}};
  for (const Fix* fix : fixes) {
    if (fix->speed_mps && *fix->speed_mps < kFastest)
      result.stretches.push_back(
          {fix->stamp.later(-kDopplerWindow / 2), fix->stamp.later(kDopplerWindow / 2), *fix->speed_mps});
  }
  return result;
}

GnssMotion gnss_turns(const std::vector<const Fix*>& fixes, bool lags) {
  const auto usable = [](const Fix* f) { return f->heading_rad && f->speed_mps.value_or(0) >= kSlow; };
  const auto given = std::count_if(fixes.begin(), fixes.end(), usable);
  if (2 * static_cast<std::size_t>(given) > fixes.size() / 2 && !lags) {
    GnssMotion result{"receiver's course", {}};
    for (std::size_t i = 1; i < fixes.size(); ++i) {
      if (usable(fixes[i - 1]) && usable(fixes[i]))
        add_turn(result, fixes[i - 1]->stamp, *fixes[i - 1]->heading_rad, fixes[i]->stamp,
                 *fixes[i]->heading_rad);
    }
    return result;
  }
  GnssMotion result{"angle between fixes", {}};
  const std::vector<const Fix*> apart = spaced(fixes);
  for (std::size_t i = 2; i < apart.size(); ++i) {
    if (!neighbours(*apart[i - 2], *apart[i - 1]) || !neighbours(*apart[i - 1], *apart[i])) continue;
    const Eigen::Vector2d first = apart[i - 1]->position - apart[i - 2]->position;
    const Eigen::Vector2d second = apart[i]->position - apart[i - 1]->position;
    if (std::min(first.norm(), second.norm()) < kShortestChord) continue;
    add_turn(result, halfway(apart[i - 2]->stamp, apart[i - 1]->stamp), std::atan2(first.y(), first.x()),
             halfway(apart[i - 1]->stamp, apart[i]->stamp), std::atan2(second.y(), second.x()));
  }
  return result;
}

}  // namespace

bool velocity_lags(const std::vector<const Fix*>& fixes) {
  constexpr double kReach_s = 3;
  constexpr double kStep_s = 0.1;
  constexpr double kLeast_s = 0.25;
  constexpr double kBetter = 0.8;  // of the squares
  constexpr std::size_t kFewest = 30;
  std::vector<const Fix*> told;
  std::copy_if(fixes.begin(), fixes.end(), std::back_inserter(told),
               [](const Fix* fix) { return fix->speed_mps.has_value(); });
  TimeSeries speeds;
  for (const Fix* fix : told) {
    speeds.stamps.push_back(fix->stamp);
    speeds.values.push_back(*fix->speed_mps);
  }
  const std::vector<Stretch> chords = chord_speeds(told);
  const auto mean_square = [&](double lag_s) {
    double sum = 0;
    std::size_t count = 0;
    for (const Stretch& chord : chords) {
      const auto speed = value_at(speeds, halfway(chord.from, chord.to).later(lag_s), kLongestInterval);
      if (!speed) continue;
      sum += std::pow(chord.value - *speed, 2);
      ++count;
    }
    return count < kFewest ? std::numeric_limits<double>::infinity() : sum / static_cast<double>(count);
  };
  const double at_once = mean_square(0);
  double least = at_once;
  double best_s = 0;
  for (double lag_s = -kReach_s; lag_s <= kReach_s + 1e-9; lag_s += kStep_s) {
    const double here = mean_square(lag_s);
    if (here < least) {
      least = here;
      best_s = lag_s;
    }
  }
  return std::abs(best_s) >= kLeast_s && least < kBetter * at_once;
}

ReceiverMotion receiver_motion(const std::vector<const Fix*>& fixes) {
  const bool lags = velocity_lags(fixes);
  return {gnss_speeds(fixes, lags), gnss_turns(fixes, lags)};
}

}  // namespace waymark::drive
