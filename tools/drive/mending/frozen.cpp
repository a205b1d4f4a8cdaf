#include <waymark/tools/drive/mending/frozen.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/tools/drive/mending/fix_motion.hpp>
#include <waymark/tools/drive/mending/laid_odometry.hpp>
#include <waymark/tools/drive/mending/reckoned.hpp>
#include <waymark/tools/drive/mending/sample_range.hpp>
#include <waymark/tools/drive/nodes/yaw_rate_at_rest.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::drive {
namespace {

constexpr double kShortestRun_s = 3;
constexpr double kShortestOfOne_s = 5;  // while the other reading is alive
constexpr std::size_t kFewestSamples = 20;
constexpr double kShortestStandstill_s = 5;
constexpr double kSameReading = 1e-9;
constexpr double kMoves = 0.5;  // m/s
constexpr double kShortestChord_s = 2;
constexpr double kLongestChord_s = 10;
constexpr std::size_t kFewestContradictions = 4;
constexpr double kLargestTurn = std::numbers::pi / 3;
constexpr double kMargin_s = 2;  // a chord contradicts some time after the motion began

/// Samples with one reading.
using Run = SampleRange;

using ReadingOf = double OdometrySample::*;

bool repeats(const OdometrySample& a, const OdometrySample& b, ReadingOf channel) {
  return std::abs(a.*channel - b.*channel) < kSameReading;
}

bool all_repeat(std::span<const OdometrySample> samples, ReadingOf channel) {
  return std::all_of(samples.begin(), samples.end(),
                     [&](const OdometrySample& sample) { return repeats(samples.front(), sample, channel); });
}

std::vector<Run> runs_of(std::span<const OdometrySample> odometry, ReadingOf channel) {
  std::vector<Run> runs;
  for (std::size_t first = 0, i = 1; i <= odometry.size(); ++i) {
    if (i < odometry.size() && repeats(odometry[first], odometry[i], channel)) continue;
    if (seconds_between(odometry[first].stamp, odometry[i - 1].stamp) >= kShortestRun_s)
      runs.push_back({first, i - 1});
    first = i;
  }
  return runs;
}

/// Returns the runs of 5 s and more at rest by speeds that differ from sample to sample.
std::vector<Run> noisy_rests_of(std::span<const OdometrySample> odometry) {
  std::vector<Run> runs;
  const auto rests = [&](std::size_t i) { return std::abs(odometry[i].speed_mps) < kMoves; };
  for (std::size_t i = 0; i < odometry.size(); ++i) {
    if (!rests(i)) continue;
    Run run{i, i};
    while (run.last + 1 < odometry.size() && rests(run.last + 1)) ++run.last;
    i = run.last;
    if (run.duration_s(odometry) >= kShortestStandstill_s &&
        !all_repeat(run.of(odometry), &OdometrySample::speed_mps))
      runs.push_back(run);
  }
  return runs;
}

/// Returns from how many samples on a run of one reading is a failure: five times the longest one of a
/// vehicle that moves, those of `runs` apart. Empty if readings do not normally differ from sample to sample.
std::optional<std::size_t> unusual_run(std::span<const OdometrySample> odometry, const std::vector<Run>& runs,
                                       ReadingOf channel) {
  constexpr std::size_t kFewestPairs = 100;
  constexpr double kLargestShare = 0.3;  // of equal pairs
  constexpr std::size_t kFactor = 5;
  std::size_t equal = 0;
  std::size_t pairs = 0;
  std::size_t in_runs = 0;
  std::size_t longest = 1;
  std::size_t length = 1;
  auto run = runs.begin();
  for (std::size_t i = 1; i < odometry.size(); ++i) {
    while (run != runs.end() && run->last < i) ++run;
    if (std::abs(odometry[i].speed_mps) < kMoves) continue;
    if (run != runs.end() && run->first < i) {
      ++in_runs;
      continue;
    }
    const bool repeated = repeats(odometry[i - 1], odometry[i], channel);
    length = repeated ? length + 1 : 1;
    longest = std::max(longest, length);
    ++pairs;
    equal += repeated;
  }
  const bool varies =
      pairs >= kFewestPairs && static_cast<double>(equal) <= kLargestShare * static_cast<double>(pairs);
  if (!varies || in_runs > pairs) return std::nullopt;
  return std::max(kFewestSamples, kFactor * longest);
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
  FrozenOdometry frozen{first.stamp, last.stamp, first.speed_mps, first.yaw_rate_radps, 0, true, false};
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

bool overlaps(const FrozenOdometry& frozen, Stamp from, Stamp to) {
  return frozen.from <= to && from <= frozen.to;
}

std::span<const OdometrySample> within(std::span<const OdometrySample> run, const FrozenOdometry& frozen) {
  const auto inside = [&](const OdometrySample& sample) { return within(sample.stamp, frozen); };
  const auto begin = std::find_if(run.begin(), run.end(), inside);
  return {begin, std::find_if_not(begin, run.end(), inside)};
}

std::span<const Fix> within(const std::vector<Fix>& fixes, Stamp from, Stamp to) {
  const auto begin =
      std::find_if(fixes.begin(), fixes.end(), [&](const Fix& fix) { return fix.stamp >= from; });
  return {begin, std::find_if(begin, fixes.end(), [&](const Fix& fix) { return fix.stamp > to; })};
}

bool drives(std::span<const OdometrySample> samples) {
  return std::all_of(samples.begin(), samples.end(),
                     [](const OdometrySample& sample) { return std::abs(sample.speed_mps) >= kMoves; });
}

double duration_of(std::span<const OdometrySample> samples) {
  return seconds_between(samples.front().stamp, samples.back().stamp);
}

/// What fixes that are never further apart than a chord may be long tell of the way between them.
struct WayOfFixes {
  double duration_s = 0;
  double chords_m = 0;  ///< no longer than the way, but for the noise of their ends
  double steps_m = 0;   ///< of 2 s or more: no shorter than the way, but for what bends cut off
};

WayOfFixes way_of(std::span<const Fix> fixes) {
  WayOfFixes way;
  std::size_t begin = 0;
  std::size_t step = 0;
  for (std::size_t i = 1; i <= fixes.size(); ++i) {
    const bool breaks =
        i == fixes.size() || seconds_between(fixes[i - 1].stamp, fixes[i].stamp) > kLongestChord_s;
    if (breaks || seconds_between(fixes[step].stamp, fixes[i - 1].stamp) >= kShortestChord_s) {
      way.steps_m += (fixes[i - 1].position - fixes[step].position).norm();
      step = i - 1;
    }
    if (!breaks) continue;
    way.duration_s += seconds_between(fixes[begin].stamp, fixes[i - 1].stamp);
    way.chords_m += (fixes[i - 1].position - fixes[begin].position).norm();
    begin = step = i;
  }
  return way;
}

/// Tells whether fixes during one speed have that speed: a vehicle on cruise control, a speed of few digits, or a
/// tram. Empty if there are too few to tell.
std::optional<bool> fixes_agree(std::span<const Fix> fixes, double speed_mps) {
  constexpr double kShare = 0.06;  // scales of wheels, and what a chord is shorter than an arc
  constexpr std::size_t kFewestHere = 4;
  if (fixes.size() < kFewestHere) return std::nullopt;
  std::vector<double> accuracies;
  for (const Fix& fix : fixes) accuracies.push_back(fix.accuracy_m());
  const WayOfFixes way = way_of(fixes);
  if (way.duration_s < kShortestChord_s) return std::nullopt;
  const double repeated_m = speed_mps * way.duration_s;
  const double allowed_m = kShare * repeated_m + upper_median(std::move(accuracies));
  return way.chords_m - allowed_m < repeated_m && repeated_m < way.steps_m + allowed_m;
}

void centre(std::vector<Complex>& places) {
  const Complex sum = std::accumulate(places.begin(), places.end(), Complex(0));
  for (Complex& place : places) place -= sum / static_cast<double>(places.size());
}

/// Returns how far fixes lie from a way, m (rms per axis), wherever that way begins, and however long it is.
double off_shape(std::span<const Fix> fixes, std::vector<Complex> way) {
  std::vector<Complex> seen;
  for (const Fix& fix : fixes) seen.emplace_back(fix.position.x(), fix.position.y());
  centre(way);
  centre(seen);
  Complex product = 0;
  double square = 0;
  for (std::size_t i = 0; i < way.size(); ++i) {
    product += std::conj(way[i]) * seen[i];
    square += std::norm(way[i]);
  }
  const Complex fit = square > 0 ? product / square : Complex(0);
  double left = 0;
  for (std::size_t i = 0; i < way.size(); ++i) left += std::norm(seen[i] - fit * way[i]);
  return std::sqrt(left / (2 * static_cast<double>(way.size())));
}

/// How the fixes of some time lie on the way of the samples of that time.
struct ShapeMatch {
  double off_m = 0;
  double length_m = 0;
  double accuracy_m = 0;  ///< of a fix, in the median
};

std::vector<ShapeMatch> shape_matches(std::span<const Fix> fixes, std::span<const OdometrySample> samples,
                                      double window_s) {
  constexpr std::size_t kFewestOfWindow = 4;
  std::vector<ShapeMatch> matches;
  for (std::size_t begin = 0; begin < fixes.size();) {
    std::size_t end = begin;
    while (end < fixes.size() && seconds_between(fixes[begin].stamp, fixes[end].stamp) <= window_s) ++end;
    const std::span<const Fix> window = fixes.subspan(begin, end - begin);
    begin = end;
    const double duration_s = seconds_between(window.front().stamp, window.back().stamp);
    if (window.size() < kFewestOfWindow || duration_s < kShortestChord_s) continue;
    std::vector<double> accuracies;
    for (const Fix& fix : window) accuracies.push_back(fix.accuracy_m());
    Reckoned way = reckoned(samples, window);
    matches.push_back(
        {off_shape(window, std::move(way.places)), way.length_m, upper_median(std::move(accuracies))});
  }
  return matches;
}

constexpr double kShape = 0.005;  // of the length: what a turn of 0.13 rad makes

/// Tells whether fixes confirm the turns of samples: they lie on the way of the samples, and are good enough to tell a
/// turn of a few degrees.
bool turns_agree(std::span<const Fix> fixes, std::span<const OdometrySample> samples) {
  constexpr double kAccuracy = 0.01;  // of the length
  constexpr double kWindow_s = 20;
  const std::vector<ShapeMatch> matches = shape_matches(fixes, samples, kWindow_s);
  return !matches.empty() && std::all_of(matches.begin(), matches.end(), [](const ShapeMatch& match) {
    return match.accuracy_m <= kAccuracy * match.length_m &&
           match.off_m <= kShape * match.length_m + match.accuracy_m;
  });
}

/// Tells whether fixes show other turns than samples of wheels, which may differ by some parts in a thousand.
bool turns_differ(std::span<const Fix> fixes, std::span<const OdometrySample> samples) {
  constexpr double kWindow_s = 60;
  constexpr double kWheels_radpm = 0.003;
  constexpr double kBow = 0.037;  // rms per axis of a bow, over its length and its turn: 1 / sqrt(720)
  const std::vector<ShapeMatch> matches = shape_matches(fixes, samples, kWindow_s);
  return std::any_of(matches.begin(), matches.end(), [](const ShapeMatch& match) {
    const double of_wheels_m = kBow * kWheels_radpm * match.length_m * match.length_m;
    return match.off_m > kShape * match.length_m + of_wheels_m + 2 * match.accuracy_m;
  });
}

/// Tells whether all readings are those of a vehicle that stands. One that comes back to a place has turned.
bool all_at_rest(std::span<const OdometrySample> samples) {
  return std::all_of(samples.begin(), samples.end(), [](const OdometrySample& sample) {
    return Interval{.speed_mps = sample.speed_mps, .yaw_rate_radps = sample.yaw_rate_radps}.stands(kMoves);
  });
}

/// Tells whether the fixes of a stop go away and come back: reflections, or positions that a receiver without
/// signals extrapolates.
bool come_back(std::span<const Fix> fixes) {
  constexpr double kShare = 0.5;
  if (fixes.empty()) return false;
  const auto away = [&](const Fix& fix) { return (fix.position - fixes.front().position).norm(); };
  double farthest = 0;
  for (const Fix& fix : fixes) farthest = std::max(farthest, away(fix));
  return away(fixes.back()) < kShare * farthest;
}

/// Tells whether a vehicle stood while its fixes wandered: afterwards they are where its odometry leads those before.
bool stood(const LaidOdometry& laid, const FrozenOdometry& frozen, Stamp end) {
  constexpr double kShare = 0.4;
  const std::optional<double> displacement_m = laid.displacement_m(frozen.from, end);
  return displacement_m && *displacement_m < kShare * frozen.distance_m;
}

/// The odometry laid on the fixes, which takes time, once it is asked for.
class LaidWhenAsked {
 public:
  LaidWhenAsked(std::span<const OdometrySample> odometry, const std::vector<Fix>& fixes)
      : odometry_(odometry), fixes_(fixes) {}
  const LaidOdometry& get() {
    if (!laid_) laid_.emplace(odometry_, fixes_);
    return *laid_;
  }

 private:
  std::span<const OdometrySample> odometry_;
  const std::vector<Fix>& fixes_;
  std::optional<LaidOdometry> laid_;
};

/// Adds the times in which fixes contradict the speed of samples. @param may_stand by all of their readings
void add_contradicted(std::span<const OdometrySample> samples, std::span<const Fix> during, bool may_stand,
                      LaidWhenAsked& laid, std::vector<FrozenOdometry>& found) {
  if (may_stand && come_back(during)) return;
  const OdometrySample& first = samples.front();
  for (const std::vector<Contradiction>& row : contradictions_of(during, std::abs(first.speed_mps))) {
    std::optional<FrozenOdometry> frozen = judged(row, during, first, samples.back());
    if (!frozen) continue;
    if (may_stand && stood(laid.get(), *frozen, samples.back().stamp)) continue;
    frozen->with_turns = all_repeat(within(samples, *frozen), &OdometrySample::yaw_rate_radps);
    found.push_back(*frozen);
  }
}

/// Finds times of one speed.
void find_frozen_speeds(std::span<const OdometrySample> odometry, const std::vector<Fix>& fixes,
                        bool is_derived, std::vector<FrozenOdometry>& found) {
  const std::vector<Run> runs = runs_of(odometry, &OdometrySample::speed_mps);
  const std::optional<std::size_t> unusual = unusual_run(odometry, runs, &OdometrySample::speed_mps);
  const std::optional<std::size_t> unusual_turns = unusual_run(
      odometry, runs_of(odometry, &OdometrySample::yaw_rate_radps), &OdometrySample::yaw_rate_radps);
  LaidWhenAsked laid(odometry, fixes);
  for (const Run& run : runs) {
    const auto samples = run.of(odometry);
    const OdometrySample& first = samples.front();
    const bool with_turns = all_repeat(samples, &OdometrySample::yaw_rate_radps);
    const bool is_long = with_turns || duration_of(samples) >= kShortestOfOne_s;
    const std::span<const Fix> during = within(fixes, first.stamp, samples.back().stamp);
    // A speed alone repeats itself on cruise control, or if it has few digits; a gyro that is alive never does. One of
    // few digits may, and then the fixes confirm it. Wheels repeat both on a straight road, unless the fixes bend.
    const bool both_repeat = with_turns && unusual_turns && samples.size() >= *unusual_turns;
    const bool gyro_stopped =
        both_repeat && (is_derived ? turns_differ(during, samples) : !turns_agree(during, samples));
    const std::optional<bool> agrees = fixes_agree(during, std::abs(first.speed_mps));
    if (!gyro_stopped && agrees.value_or(false)) continue;
    const bool is_shown = gyro_stopped || !agrees.value_or(true);
    if (is_shown && unusual && is_long && samples.size() >= *unusual && drives(samples)) {
      found.push_back({first.stamp, samples.back().stamp, first.speed_mps, first.yaw_rate_radps,
                       way_of(during).steps_m, true, with_turns});
      continue;
    }
    if (duration_of(samples) >= kShortestStandstill_s)
      add_contradicted(samples, during, !with_turns && all_at_rest(samples), laid, found);
  }
  // A speed that reads noise where it should read the motion, or 0 on a ferry.
  for (const Run& run : noisy_rests_of(odometry)) {
    const auto samples = run.of(odometry);
    std::vector<FrozenOdometry> contradicted;
    add_contradicted(samples, within(fixes, samples.front().stamp, samples.back().stamp),
                     all_at_rest(samples), laid, contradicted);
    if (contradicted.empty()) continue;
    // What it reads between two such times is worth as little.
    FrozenOdometry rest = contradicted.front();
    rest.to = contradicted.back().to;
    rest.distance_m =
        std::accumulate(contradicted.begin(), contradicted.end(), 0.0,
                        [](double sum, const FrozenOdometry& part) { return sum + part.distance_m; });
    rest.at_rest = true;
    const bool is_known = std::any_of(found.begin(), found.end(), [&](const FrozenOdometry& other) {
      return overlaps(other, rest.from, rest.to);
    });
    if (!is_known) found.push_back(rest);
  }
}

/// Finds times of one yaw rate while the speed is alive. One from wheels or steering repeats itself on
/// straight roads.
void find_frozen_turns(std::span<const OdometrySample> odometry, const std::vector<Fix>& fixes,
                       bool is_derived, std::vector<FrozenOdometry>& found) {
  const std::vector<Run> runs = runs_of(odometry, &OdometrySample::yaw_rate_radps);
  const std::optional<std::size_t> unusual = unusual_run(odometry, runs, &OdometrySample::yaw_rate_radps);
  if (!unusual || is_derived) return;
  const std::vector<FrozenOdometry> speeds = found;
  for (const Run& run : runs) {
    const auto samples = run.of(odometry);
    const Stamp from = samples.front().stamp;
    const Stamp to = samples.back().stamp;
    const bool is_known = std::any_of(speeds.begin(), speeds.end(), [&](const FrozenOdometry& other) {
      return other.with_turns && overlaps(other, from, to);
    });
    if (is_known || duration_of(samples) < kShortestOfOne_s || samples.size() < *unusual) continue;
    if (!drives(samples) || turns_agree(within(fixes, from, to), samples)) continue;
    found.push_back({from, to, samples.front().speed_mps, samples.front().yaw_rate_radps,
                     way_of(within(fixes, from, to)).steps_m, false, true});
  }
}

std::string readings_in_words(const FrozenOdometry& frozen) {
  if (frozen.at_rest) return fmt::format("reads speeds below {:.1f} m/s", kMoves);
  if (!frozen.with_speed) return fmt::format("repeats a yaw rate of {:.3g} rad/s", frozen.yaw_rate_radps);
  return fmt::format("repeats {:.3g} m/s{}", frozen.speed_mps, frozen.with_turns ? " and its yaw rate" : "");
}

}  // namespace

std::vector<FrozenOdometry> find_frozen_odometry(std::span<const OdometrySample> odometry,
                                                 std::span<const Fix> fixes, bool from_wheels) {
  std::vector<FrozenOdometry> found;
  const std::vector<Fix> all = fixes_for_motion(fixes);
  const bool is_derived = yaw_rate_at_rest(odometry, from_wheels).is_derived();
  find_frozen_speeds(odometry, all, is_derived, found);
  find_frozen_turns(odometry, all, is_derived, found);
  return found;
}

void assume_motion_of_fixes(std::span<const FrozenOdometry> frozen, std::span<const Fix> fixes,
                            std::span<OdometrySample> odometry) {
  if (frozen.empty()) return;
  const MotionOfFixes motion(fixes);
  for (OdometrySample& sample : odometry) {
    for (const FrozenOdometry& time : frozen) {
      if (!within(sample.stamp, time)) continue;
      if (time.with_speed) sample.speed_mps = motion.speed(sample.stamp);
      if (time.with_turns) sample.yaw_rate_radps = motion.yaw_rate(sample.stamp);
      sample.assumed = true;
    }
  }
}

std::string warning_of(const FrozenOdometry& frozen, Stamp start) {
  return fmt::format(
      "the odometry {} from {:.1f} s to {:.1f} s after its start, while the fixes move by "
      "{:.0f} m: its readings are left out there, and the motion of the fixes is assumed with the noise of a "
      "gap; check the log of the odometry, and the clocks of both logs",
      readings_in_words(frozen), seconds_between(start, frozen.from), seconds_between(start, frozen.to),
      frozen.distance_m);
}

}  // namespace waymark::drive
