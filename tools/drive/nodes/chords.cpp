#include <waymark/tools/drive/nodes/chords.hpp>

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

ChordPair chord(const ReckonedFixes& receiver, std::size_t first, std::size_t last) {
  return {.gnss = receiver.fixes[last].position - receiver.fixes[first].position,
          .odometry = receiver.antenna[last].head<2>() - receiver.antenna[first].head<2>()};
}

/// Returns the mean difference of the turns with a factor. A single wrong fix counts at most 1 rad.
double difference_with(double factor, std::span<const TurnPair> turns) {
  double sum = 0;
  for (const TurnPair& pair : turns)
    sum += std::min(1.0, std::abs(wrap_angle(pair.gnss_rad - factor * pair.odometry_rad)));
  return sum / static_cast<double>(turns.size());
}

double disagreement(const ReckonedFixes& receiver, std::size_t first, std::size_t last) {
  const ChordPair pair = chord(receiver, first, last);
  return std::abs(pair.gnss.norm() - pair.odometry.norm());
}

/// Returns the fix 10 s before (step -1) or after (step 1) another one. Empty if the log ends earlier.
std::optional<std::size_t> fix_10_s_from(const ReckonedFixes& receiver, std::size_t from, int step) {
  constexpr double kSettled_s = 10;
  for (auto i = static_cast<std::ptrdiff_t>(from); i >= 0 && i < std::ssize(receiver.fixes); i += step) {
    const auto at = static_cast<std::size_t>(i);
    if (std::abs(seconds_between(receiver.fixes[from].stamp, receiver.fixes[at].stamp)) >= kSettled_s)
      return at;
  }
  return std::nullopt;
}

/// Tells whether all fixes from `first` to `last` are as far from `from` as the odometry says.
bool agree(const ReckonedFixes& receiver, std::size_t from, std::size_t first, std::size_t last,
           double tolerance_m) {
  for (std::size_t i = first; i <= last; ++i)
    if (disagreement(receiver, from, i) >= tolerance_m) return false;
  return true;
}

/// Returns the part of the chord before fix i that the odometry does not explain.
/// @param before fix that begins a way along which the odometry is laid
Eigen::Vector2d unexplained(const ReckonedFixes& receiver, std::size_t before, std::size_t i) {
  const ChordPair way = chord(receiver, before, i - 1);
  const ChordPair step = chord(receiver, i - 1, i);
  return step.gnss - Eigen::Rotation2Dd(angle_between(way.odometry, way.gnss)) * step.odometry;
}

/// Returns the jump to fix i. Empty if there is none.
std::optional<Jump> jump_to(const ReckonedFixes& receiver, std::size_t i) {
  constexpr double kSmallest_m = 20;
  constexpr double kSigmas = 5;
  constexpr double kLongest_s = 60;
  constexpr double kDrift = 0.1;  // of the odometry, and of the heading in which it is laid
  const std::vector<Fix>& fixes = receiver.fixes;
  if (seconds_between(fixes[i - 1].stamp, fixes[i].stamp) > kLongest_s) return std::nullopt;
  const double claimed_m = std::max(fixes[i].accuracy_m(), fixes[i - 1].accuracy_m());
  const ChordPair step = chord(receiver, i - 1, i);
  const double least_m = std::max({kSmallest_m, kSigmas * claimed_m, kDrift * step.odometry.norm()});
  if (step.gnss.norm() + step.odometry.norm() < least_m) return std::nullopt;
  const std::optional<std::size_t> before = fix_10_s_from(receiver, i - 1, -1);
  const std::optional<std::size_t> after = fix_10_s_from(receiver, i, 1);
  if (!before || !after) return std::nullopt;
  const Eigen::Vector2d by = unexplained(receiver, *before, i);
  const double tolerance_m = 0.25 * by.norm();
  if (by.norm() < least_m || !agree(receiver, i - 1, *before, i - 1, tolerance_m) ||
      !agree(receiver, i, i, *after, tolerance_m))
    return std::nullopt;
  return Jump{i, fixes.size(), by, 0, false};
}

/// Tells whether the second of two jumps takes the fixes back.
bool undoes(const Jump& second, const Jump& first) {
  return (first.by + second.by).norm() <= 0.25 * first.by.norm();
}

/// Judges jumps of which each undoes the one before. Two of them enclose the wrong fixes, if these are less
/// than half of the log. More have the fixes at two places in turn, and the end of one burst looks like the
/// beginning of another: fixes at one of them are wrong only if those at the other last twice as long.
void mark_undone(const ReckonedFixes& receiver, std::size_t first, std::size_t last,
                 std::vector<Jump>& jumps) {
  constexpr double kClear = 2;
  const std::vector<Fix>& fixes = receiver.fixes;
  if (last == first) return;
  if (last == first + 1) {
    jumps[first].undone =
        jumps[first].stays_s < 0.5 * seconds_between(fixes.front().stamp, fixes.back().stamp);
    return;
  }
  const Stamp begin = first == 0 ? fixes.front().stamp : fixes[jumps[first - 1].first].stamp;
  double near_s = seconds_between(begin, fixes[jumps[first].first].stamp);  // where the fixes come from
  double away_s = 0;
  for (std::size_t j = first; j <= last; ++j) ((j - first) % 2 == 0 ? away_s : near_s) += jumps[j].stays_s;
  const bool is_away_wrong = kClear * away_s <= near_s;
  if (!is_away_wrong && kClear * near_s > away_s) return;
  for (std::size_t j = is_away_wrong ? first : first + 1; j < last; j += 2) jumps[j].undone = true;
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
    ChordPair next = chord(receiver, first, i);
    if (!is_complete(next)) continue;
    next.heading_rad = mean_heading(receiver, first, i);
    next.follows = unbroken;
    chords.push_back(next);
    unbroken = true;
    first = i;
  }
  return chords;
}

std::vector<TurnPair> turns_of(std::span<const ChordPair> chords) {
  std::vector<TurnPair> turns;
  for (std::size_t i = 1; i < chords.size(); ++i) {
    if (!chords[i].follows) continue;
    turns.push_back({angle_between(chords[i - 1].gnss, chords[i].gnss),
                     chords[i].heading_rad - chords[i - 1].heading_rad});
  }
  return turns;
}

std::optional<double> factor_of_turns(std::span<const TurnPair> turns) {
  if (turns.empty()) return std::nullopt;
  constexpr int kSteps = 300;  // of 3 % each, from 0.01 to 100
  double best = 1;
  double least = difference_with(1, turns);
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

std::vector<Jump> jumps_of(const ReckonedFixes& receiver) {
  const std::vector<Fix>& fixes = receiver.fixes;
  std::vector<Jump> jumps;
  for (std::size_t i = 1; i < fixes.size(); ++i)
    if (const std::optional<Jump> jump = jump_to(receiver, i)) jumps.push_back(*jump);
  for (std::size_t j = 0; j < jumps.size(); ++j) {
    if (j + 1 < jumps.size()) jumps[j].end = jumps[j + 1].first;
    jumps[j].stays_s =
        seconds_between(fixes[jumps[j].first].stamp, fixes[std::min(jumps[j].end, fixes.size() - 1)].stamp);
  }
  for (std::size_t first = 0; first < jumps.size();) {
    std::size_t last = first;
    while (last + 1 < jumps.size() && undoes(jumps[last + 1], jumps[last])) ++last;
    mark_undone(receiver, first, last, jumps);
    first = last + 1;
  }
  return jumps;
}

}  // namespace waymark::drive
