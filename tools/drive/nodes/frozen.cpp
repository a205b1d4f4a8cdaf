#include <waymark/tools/drive/nodes/frozen.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include <waymark/tools/drive/nodes/fix_motion.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::drive {
namespace {

constexpr double kShortestRun_s = 3;
constexpr double kShortestStandstill_s = 5;
constexpr double kSameReading = 1e-9;
constexpr double kStands = 0.05;  // m/s
constexpr double kMoves = 0.5;
constexpr double kShortestChord_s = 2;
constexpr double kLongestChord_s = 10;
constexpr std::size_t kFewestContradictions = 4;
constexpr double kLargestTurn = std::numbers::pi / 3;
constexpr double kMargin_s = 2;  // a chord contradicts some time after the motion began

/// Samples [first, last] with one speed.
struct Run {
  std::size_t first = 0;
  std::size_t last = 0;
};

bool repeats(const OdometrySample& a, const OdometrySample& b) {
  const bool speed = std::abs(a.speed_mps - b.speed_mps) < kSameReading;
  const bool stands = std::abs(a.speed_mps) < kStands;
  return speed && (stands || std::abs(a.yaw_rate_radps - b.yaw_rate_radps) < kSameReading);
}

std::vector<Run> runs_of(std::span<const OdometrySample> odometry) {
  std::vector<Run> runs;
  for (std::size_t first = 0, i = 1; i <= odometry.size(); ++i) {
    if (i < odometry.size() && repeats(odometry[first], odometry[i])) continue;
    if (seconds_between(odometry[first].stamp, odometry[i - 1].stamp) >= kShortestRun_s)
      runs.push_back({first, i - 1});
    first = i;
  }
  return runs;
}

/// Tells whether the readings of a moving vehicle normally differ from sample to sample, so that a
/// run of one reading is a failure. Pairs within the runs are not counted.
bool readings_vary(std::span<const OdometrySample> odometry, const std::vector<Run>& runs) {
  constexpr std::size_t kFewestPairs = 100;
  constexpr std::size_t kVaries = 20;  // at most one pair in 20 is equal
  std::size_t equal = 0;
  std::size_t pairs = 0;
  auto run = runs.begin();
  for (std::size_t i = 1; i < odometry.size(); ++i) {
    while (run != runs.end() && run->last < i) ++run;
    const bool in_run = run != runs.end() && run->first < i;
    if (in_run || std::abs(odometry[i].speed_mps) < kMoves) continue;
    ++pairs;
    equal += repeats(odometry[i - 1], odometry[i]);
  }
  return pairs >= kFewestPairs && kVaries * equal <= pairs;
}

/// Two fixes between which the odometry is wrong.
struct Contradiction {
  std::size_t first = 0;
  std::size_t last = 0;
  Eigen::Vector2d chord = Eigen::Vector2d::Zero();
  double difference_m = 0;
};

/// Tells whether the receiver's own speed, if it has one, is that of the odometry.
bool speeds_agree(const Fix& a, const Fix& b, double speed_mps) {
  if (!a.speed_mps || !b.speed_mps) return false;
  return std::abs(0.5 * (*a.speed_mps + *b.speed_mps) - speed_mps) < 1;
}

/// Returns the shortest chord from a fix that contradicts the speed.
std::optional<Contradiction> contradiction(std::span<const Fix> fixes, std::size_t first, double speed_mps) {
  for (std::size_t i = first + 1; i < fixes.size(); ++i) {
    const double dt = seconds_between(fixes[first].stamp, fixes[i].stamp);
    if (dt > kLongestChord_s) break;
    if (dt < kShortestChord_s) continue;
    const Eigen::Vector2d chord = fixes[i].position - fixes[first].position;
    const double difference = std::abs(chord.norm() - speed_mps * dt);
    const double enough = std::max({5.0, dt, 3 * std::max(fixes[first].accuracy_m(), fixes[i].accuracy_m())});
    // A receiver that repeats its position proves nothing.
    if (difference < enough || chord.isZero() || speeds_agree(fixes[first], fixes[i], speed_mps)) continue;
    return Contradiction{first, i, chord, difference};
  }
  return std::nullopt;
}

bool same_direction(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return std::abs(angle_between(a, b)) < kLargestTurn;
}

/// Returns the contradictions in a row, of fixes during one run.
std::vector<std::vector<Contradiction>> contradictions_of(std::span<const Fix> fixes, double speed_mps) {
  std::vector<std::vector<Contradiction>> rows;
  for (std::size_t i = 0; i < fixes.size();) {
    const std::optional<Contradiction> found = contradiction(fixes, i, speed_mps);
    if (!found) {
      ++i;
      continue;
    }
    const bool continues = !rows.empty() && rows.back().back().last == i &&
                           same_direction(rows.back().back().chord, found->chord);
    if (!continues) rows.emplace_back();
    rows.back().push_back(*found);
    i = found->last;
  }
  return rows;
}

std::optional<FrozenOdometry> judged(const std::vector<Contradiction>& row, std::span<const Fix> fixes,
                                     const OdometrySample& first, const OdometrySample& last) {
  FrozenOdometry frozen;
  frozen.speed_mps = first.speed_mps;
  double difference_m = 0;
  double sigma_m = 0;
  for (const Contradiction& part : row) {
    difference_m += part.difference_m;
    frozen.distance_m += part.chord.norm();
    sigma_m = std::max(sigma_m, fixes[part.last].accuracy_m());
  }
  if (row.size() < kFewestContradictions || difference_m < std::max(30.0, 10 * sigma_m)) return std::nullopt;
  const auto margin = static_cast<std::int64_t>(kMargin_s * 1e9);
  frozen.from.nanoseconds =
      std::max(first.stamp.nanoseconds, fixes[row.front().first].stamp.nanoseconds - margin);
  frozen.to.nanoseconds = std::min(last.stamp.nanoseconds, fixes[row.back().last].stamp.nanoseconds + margin);
  return frozen;
}

bool within(Stamp stamp, const FrozenOdometry& frozen) {
  return frozen.from <= stamp && stamp <= frozen.to;
}

bool turns_are_frozen(std::span<const OdometrySample> run, const FrozenOdometry& frozen) {
  return std::all_of(run.begin(), run.end(), [&](const OdometrySample& sample) {
    return !within(sample.stamp, frozen) ||
           std::abs(sample.yaw_rate_radps - run.front().yaw_rate_radps) < kSameReading;
  });
}

std::span<const Fix> within(const std::vector<Fix>& fixes, Stamp from, Stamp to) {
  const auto begin =
      std::find_if(fixes.begin(), fixes.end(), [&](const Fix& fix) { return fix.stamp >= from; });
  return {begin, std::find_if(begin, fixes.end(), [&](const Fix& fix) { return fix.stamp > to; })};
}

double length_of(std::span<const Fix> fixes) {
  double length = 0;
  for (std::size_t i = 1; i < fixes.size(); ++i) length += (fixes[i].position - fixes[i - 1].position).norm();
  return length;
}

}  // namespace

std::vector<FrozenOdometry> find_frozen_odometry(std::span<const OdometrySample> odometry,
                                                 std::span<const Fix> fixes) {
  constexpr std::size_t kFewestSamples = 20;
  std::vector<FrozenOdometry> found;
  const std::vector<Fix> all = fixes_for_motion(fixes);
  const std::vector<Run> runs = runs_of(odometry);
  const bool vary = readings_vary(odometry, runs);
  for (const Run& run : runs) {
    const auto samples = odometry.subspan(run.first, run.last - run.first + 1);
    const std::span<const Fix> during = within(all, samples.front().stamp, samples.back().stamp);
    if (vary && samples.size() >= kFewestSamples && std::abs(samples.front().speed_mps) >= kMoves) {
      found.push_back(
          {samples.front().stamp, samples.back().stamp, samples.front().speed_mps, length_of(during), true});
      continue;
    }
    if (seconds_between(samples.front().stamp, samples.back().stamp) < kShortestStandstill_s) continue;
    for (const std::vector<Contradiction>& row :
         contradictions_of(during, std::abs(samples.front().speed_mps))) {
      std::optional<FrozenOdometry> frozen = judged(row, during, samples.front(), samples.back());
      if (!frozen) continue;
      frozen->with_turns = turns_are_frozen(samples, *frozen);
      found.push_back(*frozen);
    }
  }
  return found;
}

void assume_motion_of_fixes(std::span<const FrozenOdometry> frozen, std::span<const Fix> fixes,
                            std::span<OdometrySample> odometry) {
  if (frozen.empty()) return;
  const MotionOfFixes motion(fixes);
  for (OdometrySample& sample : odometry) {
    for (const FrozenOdometry& time : frozen) {
      if (!within(sample.stamp, time)) continue;
      sample.speed_mps = motion.speed(sample.stamp);
      if (time.with_turns) sample.yaw_rate_radps = motion.yaw_rate(sample.stamp);
      sample.assumed = true;
    }
  }
}

std::string warning_of(const FrozenOdometry& frozen, Stamp start) {
  return fmt::format(
      "the odometry repeats {:.3g} m/s{} from {:.1f} s to {:.1f} s after its start, while the fixes move by "
      "{:.0f} m: its readings are left out there, and the motion of the fixes is assumed with the noise of a "
      "gap; check the log of the odometry, and the clocks of both logs",
      frozen.speed_mps, frozen.with_turns ? " and its yaw rate" : "", seconds_between(start, frozen.from),
      seconds_between(start, frozen.to), frozen.distance_m);
}

}  // namespace waymark::drive
