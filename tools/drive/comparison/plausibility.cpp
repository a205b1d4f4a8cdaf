#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <waymark/tools/drive/comparison/chords.hpp>
#include <waymark/tools/drive/comparison/frozen_fixes.hpp>
#include <waymark/tools/drive/comparison/jumps.hpp>
#include <waymark/tools/drive/comparison/plausibility.hpp>
#include <waymark/tools/drive/comparison/turn_factor.hpp>
#include <waymark/tools/drive/coordinates/coordinate_slips.hpp>

namespace waymark::drive {
namespace {

constexpr double kDegrees = std::numbers::pi / 180;
constexpr std::size_t kFewestChords = 10;
constexpr std::size_t kFewestTurns = 8;
constexpr double kLargestFactor = 1.5;

bool is_unusual(double factor) {
  return factor > kLargestFactor || factor < 1 / kLargestFactor;
}

/// Legs that show the bias of the gyro.
std::vector<ChordPair> legs_of(const ReckonedFixes& receiver) {
  constexpr double kLeg_m = 20;
  constexpr double kLongest_s = 30;
  return chords_of(receiver, kLongest_s, [](const ChordPair& leg) { return leg.gnss.norm() >= kLeg_m; });
}

/// Chords for turns end by the fixes alone, because turns in a wrong unit curl the odometry up.
std::vector<TurnPair> turns_between(const ReckonedFixes& receiver) {
  constexpr double kChord_m = 20;
  constexpr double kLongest_s = 10;
  const auto is_complete = [](const ChordPair& chord) { return chord.gnss.norm() >= kChord_m; };
  return turns_of(chords_of(receiver, kLongest_s, is_complete));
}

/// Returns the turns of 15 degrees or more: those of the fixes, or those of the odometry times a factor.
std::vector<TurnPair> large_turns(const std::vector<TurnPair>& all, double factor) {
  constexpr double kSmallest = 15 * kDegrees;
  std::vector<TurnPair> turns;
  for (const TurnPair& pair : all)
    if (std::abs(pair.gnss_rad) >= kSmallest || std::abs(factor * pair.odometry_rad) >= kSmallest)
      turns.push_back(pair);
  return turns;
}

/// How many times the odometry turns as the fixes do, if that is far from 1; negative if the sense is another one.
struct TurnSize {
  double factor = 1;
  std::size_t turns = 0;
};

/// Compares the size of the turns of the fixes. Where the vehicle hardly turns, those of the fixes alone are noise
/// that happens to be large: so the factor must explain those that it expects of the odometry as well.
std::optional<TurnSize> size_of_turns(const std::vector<TurnPair>& all) {
  std::vector<TurnPair> turns = large_turns(all, 0);
  if (turns.size() < kFewestTurns) return std::nullopt;
  std::optional<double> found = factor_of_turns(turns);
  if (!found || !is_unusual(std::abs(*found))) return std::nullopt;
  turns = large_turns(all, *found);
  found = factor_of_turns(turns);
  if (!found || !is_unusual(std::abs(*found))) return std::nullopt;
  return TurnSize{1 / *found, turns.size()};
}

std::string in_words(const TurnSize& size) {
  constexpr double kNear = 1.15;
  const double factor = std::abs(size.factor);
  const auto is_near = [&](double unit) { return factor < kNear * unit && factor > unit / kNear; };
  const char* remedy = "check the unit and the scale of the yaw rate";
  if (is_near(180 / std::numbers::pi)) remedy = "deg/s are read as rad/s: state 'unit: deg/s' of the column";
  if (is_near(std::numbers::pi / 180)) remedy = "rad/s are read as deg/s: state 'unit: rad/s' of the column";
  return fmt::format("the odometry's turns are {:.3g} times the turns of the fixes ({} turns); {}{}", factor,
                     size.turns, remedy, size.factor < 0 ? ", and 'convention: cw'" : "");
}

std::string in_words(const TurnFactor& factor) {
  return fmt::format(
      "the odometry's turns are {:.3f} times those of the fixes ({} turns, sigma {:.3f}): the scale of its yaw rate "
      "is wrong (the sensitivity of a gyro, 'track_width', 'steering_ratio'); correct it, or state how well it is "
      "known (odometry: 'options: {{yaw_scale: constant, yaw_scale_sigma: {:.2g}}}')",
      factor.value, factor.turns, factor.sigma, std::abs(1 / factor.value - 1));
}

std::string sign_of_turns(const std::vector<TurnPair>& turns) {
  constexpr double kSmallest = 5 * kDegrees;
  constexpr double kOpposite = -0.3;
  double gnss_squared = 0;
  double odometry_squared = 0;
  double product = 0;
  std::size_t count = 0;
  for (const TurnPair& pair : turns) {
    if (std::abs(pair.odometry_rad) < kSmallest) continue;
    gnss_squared += pair.gnss_rad * pair.gnss_rad;
    odometry_squared += pair.odometry_rad * pair.odometry_rad;
    product += pair.gnss_rad * pair.odometry_rad;
    ++count;
  }
  const double correlation = product / std::sqrt(gnss_squared * odometry_squared);
  if (count < kFewestTurns || !(correlation < kOpposite)) return {};
  return fmt::format(
      "the odometry turns against the fixes (correlation {:.2f} over {} turns); if the yaw rate is positive "
      "clockwise, state 'convention: cw'",
      correlation, count);
}

/// Returns how many times the way of the odometry is that of the fixes. The product of both lengths ends a chord, so
/// that the noise of the fixes of a slow vehicle does not.
std::vector<double> way_factors(const ReckonedFixes& receiver) {
  constexpr double kChord_m = 20;
  constexpr double kOneSided_m = 100;
  constexpr double kLongest_s = 30;
  const auto is_complete = [](const ChordPair& chord) {
    const double gnss = chord.gnss.norm();
    const double odometry = chord.odometry.norm();
    return gnss * odometry >= kChord_m * kChord_m || std::max(gnss, odometry) >= kOneSided_m;
  };
  std::vector<double> factors;
  for (const ChordPair& chord : chords_of(receiver, kLongest_s, is_complete))
    factors.push_back(chord.odometry.norm() / std::max(1e-3, chord.gnss.norm()));
  return factors;
}

/// Finds wrong units of the speed.
/// @param factors of way_factors()
std::string large_factor(const std::vector<double>& factors, std::optional<double>& found) {
  if (factors.size() < kFewestChords) return {};
  const double factor = median_with_sigma(factors).value;
  if (!is_unusual(factor)) return {};
  found = factor;
  return fmt::format(
      "the odometry's distance between fixes is {:.2f} times the distance of the fixes (median of {}); "
      "check the unit of the speed ({})",
      factor, factors.size(),
      factor > 1 ? "3.6: km/h read as m/s"
                 : "0.28: m/s read as km/h; otherwise the odometry stands still, or the coordinates "
                   "have few digits");
}

std::string words_for_scale(double factor, std::size_t chords, double sigma) {
  return fmt::format(
      "the odometry's distances are {:.3f} times those of the fixes (median of {}, sigma {:.3f}): its scale "
      "is wrong beyond the prior of speed_scale; correct it, or state how well it is known (odometry: 'options: "
      "{{speed_scale_sigma: {:.2g}}}')",
      factor, chords, sigma, std::abs(1 / factor - 1));
}

/// Returns how many times the ways of the fixes are those of the odometry along chords of 100 m that bend alike: what
/// turns otherwise, by a gyro that is dead for example, has other chords for the same way.
std::vector<double> chord_factors(const ReckonedFixes& receiver) {
  constexpr double kHalf_m = 50;
  constexpr double kLongest_s = 30;
  constexpr double kAlike = 0.3;  // rad: the chord of two halves that turn by so much more is 1 % shorter
  const auto is_complete = [](const ChordPair& chord) { return chord.odometry.norm() >= kHalf_m; };
  const std::vector<ChordPair> halves = chords_of(receiver, kLongest_s, is_complete);
  std::vector<double> factors;
  for (std::size_t i = 1; i < halves.size(); ++i) {
    if (!halves[i].follows || std::abs(turns_apart(halves[i - 1], halves[i])) > kAlike) continue;
    factors.push_back((halves[i - 1].gnss + halves[i].gnss).norm() /
                      (halves[i - 1].odometry + halves[i].odometry).norm());
    ++i;  // a half counts once
  }
  return factors;
}

/// Finds an error of scale beyond the prior of `speed_scale`. The noise of fixes across a chord makes
/// the chord longer by at most half the squared spread.
/// @param factors of chord_factors()
std::string small_factor(const std::vector<double>& factors, std::optional<double>& found) {
  constexpr double kUsual = 0.03;  // three sigmas of the prior of speed_scale
  constexpr double kSigmas = 4;
  const Median factor = median_with_sigma(factors);
  const double uncertain = kSigmas * factor.sigma + 0.5 * factor.spread * factor.spread;
  if (std::abs(factor.value - 1) < kUsual + uncertain) return {};
  found = 1 / factor.value;
  return words_for_scale(*found, factors.size(), factor.sigma);
}

/// Finds one on a drive that has few long chords. @param factors of way_factors()
std::string rough_factor(const std::vector<double>& factors, std::optional<double>& found) {
  constexpr double kWrong = 0.1;
  constexpr double kSigmas = 3;
  if (factors.size() < kFewestChords) return {};
  const Median factor = median_with_sigma(factors);
  const double spread = factor.spread / factor.value;
  const double uncertain = kSigmas * factor.sigma / factor.value + 0.5 * spread * spread;
  if (!(std::abs(std::log(factor.value)) > kWrong + uncertain)) return {};
  found = factor.value;
  return words_for_scale(*found, factors.size(), factor.sigma);
}

Shape shape_of(const ReckonedFixes& receiver) {
  const std::vector<TurnPair> turns = turns_between(receiver);
  const std::optional<TurnSize> size = size_of_turns(turns);
  const bool is_of_unit = size && !is_scale(size->factor);
  const std::optional<TurnFactor> factor_of_turns =
      is_of_unit ? std::nullopt : turn_factor(receiver, size ? size->factor : 1);
  // Turns of another size distort all lengths, and lengths of another unit all differences of them.
  if (size && !factor_of_turns) return {{in_words(*size)}, true, true};
  Shape shape;
  const double factor = factor_of_turns ? factor_of_turns->value : 1;
  if (factor_of_turns) {
    shape.turn_factor = factor;
    shape.contradicts = size.has_value();
    shape.sentences.push_back(in_words(*factor_of_turns));
  }
  const YawBias bias = bias_of(legs_of(without_error(receiver, {.factor = factor})));
  if (bias.is_large()) shape.yaw_bias = bias;
  const ReckonedFixes straight = without_error(receiver, bias.with(factor));
  const std::vector<double> ways = way_factors(straight);
  const std::vector<double> chords = chord_factors(straight);
  if (std::string sign = sign_of_turns(turns); !sign.empty()) {
    shape.sentences.push_back(std::move(sign));
    shape.contradicts = true;
  }
  if (std::string sentence = large_factor(ways, shape.speed_factor); !sentence.empty()) {
    shape.sentences.push_back(std::move(sentence));
    shape.contradicts = true;
    shape.spoils_jumps = true;
  } else {
    sentence = chords.size() >= kFewestChords ? small_factor(chords, shape.speed_factor)
                                              : rough_factor(ways, shape.speed_factor);
    if (!sentence.empty()) shape.sentences.push_back(std::move(sentence));
  }
  return shape;
}

/// Looks for slips without which nothing is wrong, and names them. A mirror is only one of two reasons
/// for turns of the other sense.
void name_slips(const ReckonedFixes& receiver, const GeodeticPoint& place, Shape& shape) {
  std::vector<const CoordinateSlip*> found;
  bool mirrors = false;
  for (const CoordinateSlip& slip : coordinate_slips()) {
    if (mirrors && slip.mirrors) continue;
    const Eigen::Matrix2d meant = mending(slip, place);
    ReckonedFixes mended = receiver;
    for (Fix& fix : mended.fixes) fix.position = meant * fix.position;
    if (!shape_of(mended).sentences.empty()) continue;
    mirrors = mirrors || slip.mirrors;
    found.push_back(&slip);
  }
  if (found.empty()) return;
  const std::string words = fmt::format("{}", fmt::join(words_of(found), ", or "));
  if (mirrors || (shape.speed_factor && shape.sentences.size() == 1)) {
    shape.sentences.front() += ", unless " + words;
    return;
  }
  shape.sentences = {"the odometry does not fit the fixes, but it does if " + words};
  shape.turn_factor.reset();
  shape.yaw_bias.reset();
  shape.spoils_jumps = true;
}

/// Returns 1 for each fix that repeats a position.
std::vector<char> marked(const std::vector<FrozenFixes>& frozen, std::size_t fixes) {
  std::vector<char> marks(fixes, 0);
  for (const FrozenFixes& place : frozen)
    for (const std::size_t i : place.repeated) marks[i] = 1;
  return marks;
}

std::string in_words(const Jump& jump, const ReckonedFixes& receiver) {
  const double at_s = seconds_between(receiver.fixes.front().stamp, receiver.fixes[jump.first].stamp);
  const double size_m = jump.by.norm();
  constexpr double kWhole_m = 20;
  const std::string size =
      size_m < kWhole_m ? fmt::format("{:.2g} m", size_m) : fmt::format("{:.0f} m", size_m);
  const std::string claim =
      jump.claimed_m > 0 ? fmt::format(", where they claim {:.2g} m", jump.claimed_m) : std::string();
  if (jump.undone)
    return fmt::format(
        "the fixes jump by {} at {:.1f} s after the first fix{}, and back after {:.0f} s; the odometry does "
        "not move so: the {} fixes between are left out (rejected: jump)",
        size, at_s, claim, jump.stays_s, jump.end - jump.first);
  return fmt::format(
      "the fixes jump by {} at {:.1f} s after the first fix{}, and stay there for {:.0f} s{}; the "
      "odometry does not move so: the fixes before or after it are wrong, and no gate rejects them once "
      "they agree among themselves",
      size, at_s, claim, jump.stays_s, jump.end < receiver.fixes.size() ? "" : ", until the end");
}

/// The words for jumps that name at most three of them. A jump back is named with the one it undoes.
std::vector<std::string> jumps_in_words(const ReckonedFixes& receiver) {
  constexpr std::size_t kMost = 3;
  constexpr double kLarge_m = 50;  // reflections make smaller ones that stay
  std::vector<std::string> sentences;
  const std::vector<Jump> jumps = jumps_of(receiver);
  for (std::size_t i = 0; i < jumps.size(); ++i) {
    const bool jumps_back = std::any_of(jumps.begin(), jumps.end(), [&](const Jump& before) {
      return before.undone && before.end == jumps[i].settled;
    });
    const std::vector<Fix>& fixes = receiver.fixes;
    // one that the fusion knows is told there
    if (fixes[jumps[i].settled].level != fixes[jumps[i].first - 1].level) continue;
    const bool at_once = jumps[i].usual_m == 0;  // what takes time and stays may be the odometry's
    const bool is_told = at_once && (jumps[i].by.norm() >= kLarge_m || jumps[i].claimed_m > 0);
    if (!jumps_back && (jumps[i].undone || is_told)) sentences.push_back(in_words(jumps[i], receiver));
  }
  if (sentences.size() > kMost) {
    const std::size_t more = sentences.size() - kMost;
    sentences.resize(kMost);
    sentences.push_back(fmt::format("the fixes jump {} more times", more));
  }
  return sentences;
}

}  // namespace

std::string warning_of_accelerations(std::span<const OdometrySample> odometry) {
  constexpr double kLargest = 25;  // m/s^2: racing cars reach half of it, and deg/s are 57 times as much
  constexpr double kDrives = 2;    // m/s
  constexpr double kShare = 0.05;
  std::size_t driving = 0;
  std::size_t impossible = 0;
  for (const OdometrySample& sample : odometry) {
    const double speed = std::abs(sample.speed_mps);
    if (speed < kDrives) continue;
    ++driving;
    impossible += speed * std::abs(sample.yaw_rate_radps) > kLargest;
  }
  const double share = driving == 0 ? 0 : static_cast<double>(impossible) / static_cast<double>(driving);
  if (share <= kShare) return {};
  return fmt::format(
      "speed times yaw rate exceeds {:g} m/s^2 in {:.0f} % of the driving, more than tyres hold: check "
      "their units (57.3: deg/s read as rad/s, state 'unit: deg/s' of the column)",
      kLargest, 100 * share);
}

Shape compare_shapes(std::span<const Fix> fixes, std::span<const Eigen::Vector3d> antenna) {
  if (fixes.empty()) return {};
  return shape_of(of_receiver(fixes, antenna, fixes.front().source));
}

ComparedWithFixes compare_odometry_with_fixes(std::span<const Fix> fixes,
                                              std::span<const Eigen::Vector3d> antenna,
                                              const std::optional<GeodeticPoint>& place,
                                              std::span<const std::string> receivers,
                                              const std::string& odometry) {
  ComparedWithFixes compared;
  std::vector<std::string>& warnings = compared.warnings;
  std::vector<Fix> live(fixes.begin(), fixes.end());
  std::vector<Eigen::Vector3d> reckoned(antenna.begin(), antenna.end());
  const std::vector<FrozenFixes> frozen = find_frozen_fixes(fixes, antenna);
  for (const FrozenFixes& one : frozen) warnings.push_back(warning_of(one, fixes.front().stamp));
  const std::vector<char> is_frozen = marked(frozen, fixes.size());
  std::size_t at = 0;
  std::erase_if(live, [&](const Fix&) { return is_frozen[at++] != 0; });
  at = 0;
  std::erase_if(reckoned, [&](const Eigen::Vector3d&) { return is_frozen[at++] != 0; });
  const int first = fixes.empty() ? 0 : fixes.front().source;
  const ReckonedFixes receiver = of_receiver(live, reckoned, first);
  Shape shape = shape_of(receiver);
  compared.speed_factor = shape.speed_factor;
  const std::vector<std::string> known = odometry.empty() ? std::vector<std::string>() : shape.sentences;
  if (place && !shape.sentences.empty()) name_slips(receiver, *place, shape);
  compared.turn_factor = shape.turn_factor;
  compared.yaw_bias = shape.yaw_bias;
  for (const std::string& sentence : shape.sentences)
    if (std::find(known.begin(), known.end(), sentence) == known.end())
      warnings.push_back((odometry.empty() ? "" : odometry + ": ") + sentence);
  if (shape.spoils_jumps) return compared;
  const YawError error = shape.yaw_bias.value_or(YawBias()).with(shape.turn_factor.value_or(1));
  for (std::string& jump : jumps_in_words(without_error(receiver, error)))
    warnings.push_back(std::move(jump));
  for (int source = 0; source < std::ssize(receivers); ++source) {
    if (source == first) continue;
    for (const std::string& jump : jumps_in_words(without_error(of_receiver(live, reckoned, source), error)))
      warnings.push_back(receivers[static_cast<std::size_t>(source)] + ": " + jump);
  }
  return compared;
}

}  // namespace waymark::drive
