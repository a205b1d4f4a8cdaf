#include <waymark/tools/drive/comparison/misreading.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <waymark/tools/drive/comparison/chords.hpp>
#include <waymark/tools/drive/comparison/turn_factor.hpp>
#include <waymark/tools/drive/coordinates/coordinate_slips.hpp>

namespace waymark::drive {
namespace {

constexpr double kDegreesOfRadian = 180 / std::numbers::pi;

/// A unit, and what is read where another one was meant.
struct NamedFactor {
  double factor;  ///< of the odometry as read
  const char* words;
};
constexpr std::array kSpeeds{NamedFactor{3.6, "km/h read as m/s: state 'unit: km/h' of the speed"},
                             NamedFactor{1 / 3.6, "m/s read as km/h: state 'unit: m/s' of the speed"},
                             NamedFactor{2.23694, "mph read as m/s: state 'unit: mph' of the speed"},
                             NamedFactor{1.94384, "knots read as m/s: state 'unit: kn' of the speed"},
                             NamedFactor{1000, "mm/s read as m/s: state 'unit: mm/s' of the speed"}};
constexpr std::array kYawRates{
    NamedFactor{kDegreesOfRadian, "deg/s read as rad/s: state 'unit: deg/s' of the yaw rate"},
    NamedFactor{1 / kDegreesOfRadian, "rad/s read as deg/s: state 'unit: rad/s' of the yaw rate"}};

/// Returns the words of the unit; null for a factor of none.
const char* name_of(double factor, std::span<const NamedFactor> names) {
  constexpr double kNear = 1.02;
  for (const NamedFactor& name : names)
    if (factor < kNear * name.factor && factor > name.factor / kNear) return name.words;
  return nullptr;
}

std::string words_for_speed(double factor) {
  const std::string words = fmt::format("speeds divided by {:.3g}", factor);
  const char* unit = name_of(factor, kSpeeds);
  return fmt::format("{} ({})", words, unit == nullptr ? "check their column and unit" : unit);
}

/// How the logs may have been meant.
struct Reading {
  double speed_factor = 1;  ///< as read, of what was meant
  double yaw_factor = 1;
  const CoordinateSlip* slip = nullptr;

  [[nodiscard]] bool is_as_read() const { return slip == nullptr && speed_factor == 1 && yaw_factor == 1; }
};

std::string in_words(const Reading& reading) {
  if (reading.slip != nullptr) return fmt::format("if {}", reading.slip->words);
  std::vector<std::string> words;
  if (reading.speed_factor != 1) words.push_back(words_for_speed(reading.speed_factor));
  const double size = std::abs(reading.yaw_factor);
  if (const char* unit = name_of(size, kYawRates))
    words.push_back(fmt::format("yaw rates divided by {:.3g} ({})", size, unit));
  if (reading.yaw_factor < 0)
    words.emplace_back("the yaw rate positive clockwise (state 'convention: cw' of the yaw rate)");
  return fmt::format("with {}", fmt::join(words, ", and "));
}

constexpr double kNoTurns = std::numeric_limits<double>::infinity();
/// What yaw rates may have to be divided by, the simplest first.
constexpr std::array kYawFactors = {
    1.0, -1.0, kDegreesOfRadian, 1 / kDegreesOfRadian, -kDegreesOfRadian, -1 / kDegreesOfRadian, kNoTurns};

constexpr std::array kLegs_m = {20.0, 60.0, 180.0};
using Legs = std::array<std::vector<ChordPair>, kLegs_m.size()>;

/// The legs of a receiver beside those of the odometry, as it was read and with other yaw rates.
class ReckonedDrive {
 public:
  ReckonedDrive(const Timeline& timeline, std::span<const Fix> fixes, double standstill_mps)
      : timeline_(timeline), fixes_(fixes), standstill_mps_(standstill_mps) {
    const ReckonedFixes as_read = reckoned({});
    for (const double factor : kYawFactors)
      legs_[factor] = legs_of(factor == 1 ? as_read : reckoned({.factor = factor}));
    calibrated_ = legs_of(reckoned(error_of_yaw_rates(as_read)));
  }

  /// @param length place in kLegs_m
  [[nodiscard]] const std::vector<ChordPair>& legs(double yaw_factor, std::size_t length) const {
    return legs_.at(yaw_factor)[length];
  }
  /// Returns those of the drive as it was read, without the scale and the bias of the yaw rate.
  [[nodiscard]] const std::vector<ChordPair>& calibrated_legs(std::size_t length) const {
    return calibrated_[length];
  }

 private:
  [[nodiscard]] ReckonedFixes reckoned(const YawError& error) const {
    const Timeline other = without_error(timeline_, error);
    return of_receiver(fixes_, reckoned_antenna(other, fixes_, standstill_mps_), fixes_.front().source);
  }

  static Legs legs_of(const ReckonedFixes& receiver) {
    constexpr double kLongest_s = 30;
    Legs legs;
    for (std::size_t i = 0; i < legs.size(); ++i)
      legs[i] = chords_of(receiver, kLongest_s,
                          [&](const ChordPair& chord) { return chord.gnss.norm() >= kLegs_m[i]; });
    return legs;
  }

  static YawError error_of_yaw_rates(const ReckonedFixes& as_read) {
    const std::optional<TurnFactor> factor = turn_factor(as_read);
    const double scale = factor ? factor->value : 1;
    return bias_of(legs_of(without_error(as_read, {.factor = scale})).front()).with(scale);
  }

  const Timeline& timeline_;
  std::span<const Fix> fixes_;
  double standstill_mps_;
  std::map<double, Legs> legs_;  ///< by kYawFactors
  Legs calibrated_;
};

/// By how much the turn from one leg to the next differs, in rad; infinite if their lengths do.
/// @param factor by which the motion of the odometry may be longer than that of the fixes
double difference_of(const ChordPair& one, const ChordPair& next, double factor) {
  constexpr double kLengths = 1.3;
  for (const ChordPair* leg : {&one, &next}) {
    const double ratio = leg->odometry.norm() / (factor * leg->gnss.norm());
    if (!(ratio < kLengths && ratio > 1 / kLengths)) return std::numeric_limits<double>::infinity();
  }
  return std::abs(turns_apart(one, next));
}

/// Returns that of each two legs that follow each other.
std::vector<double> differences_of(std::span<const ChordPair> legs, double factor) {
  std::vector<double> differences;
  for (std::size_t i = 1; i < legs.size(); ++i)
    if (legs[i].follows) differences.push_back(difference_of(legs[i - 1], legs[i], factor));
  return differences;
}

std::size_t count_within(double tolerance_rad, std::span<const double> differences) {
  return static_cast<std::size_t>(
      std::count_if(differences.begin(), differences.end(), [&](double one) { return one < tolerance_rad; }));
}

/// How many pairs agree by one reading, and do not by another one.
struct Comparison {
  std::size_t gained = 0;
  std::size_t lost = 0;
};

/// @param before, after of the same pairs
Comparison compare(std::span<const double> before, std::span<const double> after, double tolerance_rad) {
  Comparison counts;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const bool agreed = before[i] < tolerance_rad;
    const bool agrees = after[i] < tolerance_rad;
    counts.gained += agrees && !agreed;
    counts.lost += agreed && !agrees;
  }
  return counts;
}

/// Tells whether another reading explains what the drive as it was read does not.
bool mends(std::span<const double> as_read, std::span<const double> other, double tolerance_rad) {
  constexpr std::size_t kFewest = 10;
  constexpr std::size_t kTimesAsMany = 10;
  const Comparison counts = compare(as_read, other, tolerance_rad);
  return counts.gained >= kFewest && counts.gained >= kTimesAsMany * counts.lost &&
         2 * count_within(tolerance_rad, other) > other.size();
}

/// Tells whether turns are of use: most of a road is straight, and no turns at all explain it too.
bool turns_rightly(std::span<const double> straight, std::span<const double> other, double tolerance_rad) {
  constexpr std::size_t kFewest = 3;
  constexpr std::size_t kTimesAsMany = 2;
  const Comparison counts = compare(straight, other, tolerance_rad);
  return counts.gained >= kFewest + counts.lost && counts.gained >= kTimesAsMany * counts.lost;
}

double median_factor(std::span<const ChordPair> legs) {
  std::vector<double> factors;
  for (const ChordPair& leg : legs) factors.push_back(leg.odometry.norm() / leg.gnss.norm());
  return median_with_sigma(std::move(factors)).value;
}

/// A reading, and how its legs differ from those of the fixes.
struct Candidate {
  Reading reading;
  std::vector<double> differences;
};

/// Returns the words for slips of coordinates that explain the drive as well.
std::string in_words(std::span<const CoordinateSlip* const> slips) {
  return slips.empty() ? "" : fmt::format(", unless {}", fmt::join(words_of(slips), " or "));
}

/// Returns the candidate with which most pairs agree. A later one must make five more agree; coordinates that do
/// as well are named with it.
/// @param candidates the first one is the drive as it was read
std::optional<std::string> best_of(std::span<const Candidate> candidates, double length_m,
                                   double tolerance_rad) {
  constexpr std::size_t kMore = 5;
  if (candidates.empty()) return std::nullopt;
  const std::vector<double>& as_read = candidates.front().differences;
  const auto straight = std::find_if(candidates.begin(), candidates.end(), [](const Candidate& candidate) {
    return candidate.reading.yaw_factor == kNoTurns;
  });
  const Reading* best = nullptr;
  std::size_t agree = 0;
  std::vector<const CoordinateSlip*> as_good;
  for (const auto& [reading, differences] : candidates) {
    if (reading.is_as_read() || !mends(as_read, differences, tolerance_rad)) continue;
    if (reading.yaw_factor != 1 && !turns_rightly(straight->differences, differences, tolerance_rad))
      continue;
    const std::size_t count = count_within(tolerance_rad, differences);
    if (best == nullptr || count >= agree + kMore) {
      best = &reading;
      agree = count;
      as_good.clear();
    } else if (reading.slip != nullptr && count + kMore > agree) {
      as_good.push_back(reading.slip);
    }
  }
  if (best == nullptr) return std::nullopt;
  return fmt::format(
      "the odometry does not fit the fixes ({} of {} pairs of legs of {:g} m agree), but it does ({} agree) {}{}",
      count_within(tolerance_rad, as_read), as_read.size(), length_m, agree, in_words(*best),
      in_words(as_good));
}

/// Whether a factor of the speed is no unit, so that it is a matter of calibration.
bool is_calibration(double factor) {
  return name_of(factor, kSpeeds) == nullptr && is_scale(factor);
}

/// Returns the differences of legs at their scale.
std::vector<double> differences_at_scale(std::span<const ChordPair> legs) {
  const double found = median_factor(legs);
  return differences_of(legs, is_calibration(found) ? found : 1);
}

/// Returns the drive as it was read. Scales and a bias of the gyro are no unit's fault.
Candidate as_read(const ReckonedDrive& drive, std::size_t length) {
  constexpr double kWide_rad = 0.3;
  Candidate best{{}, differences_of(drive.legs(1, length), 1)};
  for (std::vector<double> differences :
       {differences_at_scale(drive.legs(1, length)), differences_at_scale(drive.calibrated_legs(length))})
    if (count_within(kWide_rad, differences) > count_within(kWide_rad, best.differences))
      best.differences = std::move(differences);
  return best;
}

/// Returns the differences with yaw rates divided by a factor, and speeds by that which then fits.
Candidate with_yaw_rates(double yaw_factor, const ReckonedDrive& drive, std::size_t length) {
  const std::vector<ChordPair>& legs = drive.legs(yaw_factor, length);
  const double found = median_factor(legs);
  if (is_calibration(found)) return {{1, yaw_factor}, differences_of(legs, found)};
  // Both wrong at once are units, not chance: what curls up is short, and fits a point.
  const bool is_unit = yaw_factor == 1 || is_scale(found);
  const double speed_factor = is_unit ? found : 1;
  return {{speed_factor, yaw_factor}, differences_of(legs, speed_factor)};
}

/// Returns the drive as it was read, and as it may have been meant, the simplest first.
std::vector<Candidate> candidates_for(const ReckonedDrive& drive, std::size_t length,
                                      const std::optional<GeodeticPoint>& place) {
  const std::vector<ChordPair>& written = drive.legs(1, length);
  if (written.empty()) return {};
  std::vector<Candidate> candidates = {as_read(drive, length)};
  for (const double yaw_factor : kYawFactors) candidates.push_back(with_yaw_rates(yaw_factor, drive, length));
  if (!place) return candidates;
  for (const CoordinateSlip& slip : coordinate_slips()) {
    const Eigen::Matrix2d meant = mending(slip, *place);
    std::vector<ChordPair> legs = written;
    for (ChordPair& leg : legs) leg.gnss = meant * leg.gnss;
    candidates.push_back({{.slip = &slip}, differences_of(legs, 1)});
  }
  return candidates;
}

}  // namespace

std::optional<std::string> find_misreading(const Timeline& timeline, std::span<const Fix> fixes,
                                           double standstill_mps, const std::optional<GeodeticPoint>& place) {
  if (fixes.empty()) return std::nullopt;
  const ReckonedDrive drive(timeline, fixes, standstill_mps);
  for (std::size_t length = 0; length < kLegs_m.size(); ++length) {
    const std::vector<Candidate> candidates = candidates_for(drive, length, place);
    for (const double tolerance_rad : {0.3, 0.15, 0.075})
      if (std::optional<std::string> found = best_of(candidates, kLegs_m[length], tolerance_rad))
        return found;
  }
  return std::nullopt;
}

}  // namespace waymark::drive
