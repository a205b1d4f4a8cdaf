#include <waymark/tools/drive/mending/reversing.hpp>

#include <algorithm>
#include <cmath>
#include <complex>

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/tools/drive/logs/time_series.hpp>
#include <waymark/tools/drive/mending/fix_motion.hpp>
#include <waymark/tools/drive/nodes/yaw_rate_at_rest.hpp>

namespace waymark::drive {
namespace {

using Complex = std::complex<double>;

constexpr double kStands = 0.5;  // m/s
constexpr double kShortest_m = 5;
constexpr double kEnd_s = 30;        // the ends of a long way are compared with its neighbours
constexpr double kFurthest_s = 120;  // a gyro drifts
constexpr double kCoherence = 0.9;
constexpr double kPreference = 0.3;  // for forwards
constexpr double kHeaviest_m = 100;

/// How the fixes of a time lie to the odometry.
struct Alignment {
  Complex turn;         ///< of length 1: from the odometry's frame to that of the fixes
  double weight_m = 0;  ///< way, at most kHeaviest_m; 0: the fixes do not have the shape of the odometry
};

/// The way between two stops.
struct Way {
  Reversing samples;
  Alignment begin;
  Alignment end;
  double length_m = 0;
  std::size_t first_part = 0;  ///< of the odometry, at its begin: parts_of()
  std::size_t last_part = 0;
  bool backwards = false;
};

double median_yaw_rate_at_rest(std::span<const OdometrySample> odometry) {
  constexpr double kRests = 0.05;  // m/s
  if (!yaw_rate_at_rest(odometry).is_known()) return 0;
  std::vector<double> readings;
  for (const OdometrySample& sample : odometry)
    if (std::abs(sample.speed_mps) < kRests) readings.push_back(sample.yaw_rate_radps);
  return upper_median(std::move(readings));
}

/// How the yaw rate of an odometry drifts from that of the vehicle.
struct Drift {
  double radps = 0;  ///< bias of a gyro
  double radpm = 0;  ///< turns of wheels whose radii differ, or of a steering angle that is off
};

/// Positions of the odometry at its samples, from the origin.
std::vector<Complex> positions_of(std::span<const OdometrySample> odometry, const Drift& drift) {
  std::vector<Complex> positions(1);
  double heading = 0;
  for (std::size_t i = 1; i < odometry.size(); ++i) {
    const OdometrySample& a = odometry[i - 1];
    const OdometrySample& b = odometry[i];
    const double dt = seconds_between(a.stamp, b.stamp);
    const double length = 0.5 * dt * (a.speed_mps + b.speed_mps);
    const double turn =
        dt * (0.5 * (a.yaw_rate_radps + b.yaw_rate_radps) - drift.radps) - length * drift.radpm;
    positions.push_back(positions.back() + std::polar(length, heading + 0.5 * turn));
    heading += turn;
  }
  return positions;
}

/// Compares odometry and fixes.
class Comparison {
 public:
  Comparison(std::span<const OdometrySample> odometry, std::span<const Fix> fixes)
      : odometry_(odometry), fixes_(fixes_for_motion(fixes)) {
    drift_.radps = median_yaw_rate_at_rest(odometry);
    reckon();
  }

  /// Removes more drift from the odometry.
  void remove(const Drift& more) {
    drift_.radps += more.radps;
    drift_.radpm += more.radpm;
    reckon();
  }

  /// Tells whether the fixes about a time are as near to each other as they claim.
  [[nodiscard]] bool stays(Stamp from, Stamp to) const {
    const auto after = first_since(to);
    const auto later = std::upper_bound(fixes_.begin(), fixes_.end(), from,
                                        [](Stamp stamp, const Fix& fix) { return stamp < fix.stamp; });
    if (after == fixes_.end() || later == fixes_.begin()) return false;
    const Fix& before = *std::prev(later);
    return (after->position - before.position).norm() <= after->accuracy_m() + before.accuracy_m();
  }

  [[nodiscard]] double length_m(std::size_t first, std::size_t last) const {
    double length = 0;
    for (std::size_t i = first + 1; i <= last; ++i) length += std::abs(positions_[i] - positions_[i - 1]);
    return length;
  }

  /// Lays the odometry of a time on its fixes.
  [[nodiscard]] Alignment alignment(Stamp from, Stamp to) const {
    constexpr std::size_t kFewestFixes = 3;
    constexpr double kLargestFactor = 1.6;
    const auto begin = first_since(from);
    const auto end = first_since(to);
    const std::span<const Fix> during(begin, end);
    if (during.size() < kFewestFixes) return {};
    Complex middle_of_fixes;
    Complex middle_of_odometry;
    std::vector<Complex> places;
    for (const Fix& fix : during) {
      places.push_back(position_at(fix.stamp));
      middle_of_fixes += place_of(fix);
      middle_of_odometry += places.back();
    }
    const double count = static_cast<double>(during.size());
    middle_of_fixes /= count;
    middle_of_odometry /= count;
    Complex product;
    double of_fixes = 0;
    double of_odometry = 0;
    double accuracy_m = 0;
    for (std::size_t i = 0; i < during.size(); ++i) {
      const Complex fix = place_of(during[i]) - middle_of_fixes;
      const Complex reckoned = places[i] - middle_of_odometry;
      product += fix * std::conj(reckoned);
      of_fixes += std::norm(fix);
      of_odometry += std::norm(reckoned);
      accuracy_m = std::max(accuracy_m, during[i].accuracy_m());
    }
    const double spread_m = std::sqrt(of_odometry / count);
    const double factor = std::sqrt(of_fixes / of_odometry);
    const bool is_clear = std::abs(product) >= kCoherence * std::sqrt(of_fixes * of_odometry) &&
                          factor < kLargestFactor && factor > 1 / kLargestFactor;
    if (spread_m < std::max(0.3 * kShortest_m, 0.5 * accuracy_m) || !is_clear) return {};
    return {product / std::abs(product), std::min(kHeaviest_m, std::sqrt(12.0) * spread_m)};
  }

 private:
  void reckon() { positions_ = positions_of(odometry_, drift_); }
  [[nodiscard]] std::vector<Fix>::const_iterator first_since(Stamp moment) const {
    return std::lower_bound(fixes_.begin(), fixes_.end(), moment,
                            [](const Fix& fix, Stamp stamp) { return fix.stamp < stamp; });
  }
  static Complex place_of(const Fix& fix) { return {fix.position.x(), fix.position.y()}; }

  [[nodiscard]] Complex position_at(Stamp stamp) const {
    const auto right =
        std::lower_bound(odometry_.begin(), odometry_.end(), stamp,
                         [](const OdometrySample& sample, Stamp at) { return sample.stamp < at; });
    if (right == odometry_.begin()) return positions_.front();
    if (right == odometry_.end()) return positions_.back();
    const auto i = static_cast<std::size_t>(right - odometry_.begin());
    const double share = seconds_between(odometry_[i - 1].stamp, stamp) /
                         seconds_between(odometry_[i - 1].stamp, odometry_[i].stamp);
    return (1 - share) * positions_[i - 1] + share * positions_[i];
  }

  std::span<const OdometrySample> odometry_;
  std::vector<Fix> fixes_;
  Drift drift_;
  std::vector<Complex> positions_;
};

/// How far the odometry turned from the fixes, between two times.
struct Drifted {
  double turn_rad = 0;
  double duration_s = 0;
  double length_m = 0;
};

/// Compares short times that follow each other while the vehicle moves. It does not matter whether it reverses.
std::vector<Drifted> drifted_of(std::span<const OdometrySample> odometry, const Comparison& comparison) {
  constexpr double kShort_s = 10;
  std::vector<Drifted> result;
  Alignment before;
  std::size_t first_before = 0;
  for (std::size_t first = 0; first < odometry.size();) {
    std::size_t last = first;
    bool moves = true;
    while (last + 1 < odometry.size() &&
           seconds_between(odometry[first].stamp, odometry[last].stamp) < kShort_s)
      moves = odometry[++last].speed_mps >= kStands && moves;
    if (last == first) break;
    const Alignment here =
        moves ? comparison.alignment(odometry[first].stamp, odometry[last].stamp) : Alignment{};
    if (here.weight_m > 0 && before.weight_m > 0)
      result.push_back({-std::arg(here.turn * std::conj(before.turn)),
                        0.5 * seconds_between(odometry[first_before].stamp, odometry[last].stamp),
                        0.5 * comparison.length_m(first_before, last)});
    before = here;
    first_before = first;
    first = last;
  }
  return result;
}

/// Returns the drift that explains the turns with the least sum of remainders, near none if they do not tell it.
/// @param has_bias false: only turns per metre
Drift drift_of(std::span<const Drifted> turns, bool has_bias) {
  constexpr int kRounds = 20;
  constexpr double kNoise_rad = 0.1;
  const Eigen::Vector2d usual(has_bias ? 0.05 : 1e-6, 0.01);  // rad/s, rad/m
  Eigen::Vector2d drift = Eigen::Vector2d::Zero();
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix2d information = usual.cwiseAbs2().cwiseInverse().asDiagonal();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
    for (const Drifted& turn : turns) {
      const Eigen::Vector2d row(turn.duration_s, turn.length_m);
      const double weight = 1 / (kNoise_rad * std::max(kNoise_rad, std::abs(turn.turn_rad - row.dot(drift))));
      information += weight * row * row.transpose();
      right += weight * turn.turn_rad * row;
    }
    drift = information.ldlt().solve(right);
  }
  return {drift.x(), drift.y()};
}

/// Compares them after the drift is removed, which may turn the way after a stop against the one before.
Comparison comparison_without_drift(std::span<const OdometrySample> odometry, std::span<const Fix> fixes) {
  constexpr int kTimes = 2;  // the second time with straighter pieces
  Comparison comparison(odometry, fixes);
  const bool has_bias = !yaw_rate_at_rest(odometry).is_derived();
  for (int k = 0; k < kTimes; ++k) comparison.remove(drift_of(drifted_of(odometry, comparison), has_bias));
  return comparison;
}

/// Returns for each sample how many silences of the odometry were before it in which the vehicle may have moved.
/// How it turned then is not known, so the frames of the odometry before and after are two.
std::vector<std::size_t> parts_of(std::span<const OdometrySample> odometry, const Comparison& comparison) {
  constexpr double kSilence_s = 2;
  const double silence_s = longest_silence_s(
      series_of({odometry.begin(), odometry.end()}, &OdometrySample::speed_mps), kSilence_s);
  std::vector<std::size_t> parts(odometry.size(), 0);
  for (std::size_t i = 1; i < odometry.size(); ++i) {
    const OdometrySample& before = odometry[i - 1];
    const OdometrySample& after = odometry[i];
    const bool stands =
        std::max(before.speed_mps, after.speed_mps) < kStands && comparison.stays(before.stamp, after.stamp);
    const bool is_silent = seconds_between(before.stamp, after.stamp) > silence_s;
    parts[i] = parts[i - 1] + (is_silent && !stands ? 1 : 0);
  }
  return parts;
}

std::vector<Way> ways_of(std::span<const OdometrySample> odometry, const Comparison& comparison) {
  std::vector<Way> ways;
  const std::vector<std::size_t> parts = parts_of(odometry, comparison);
  for (std::size_t first = 0; first < odometry.size(); ++first) {
    if (odometry[first].speed_mps < kStands) continue;
    std::size_t last = first;
    while (last + 1 < odometry.size() && odometry[last + 1].speed_mps >= kStands) ++last;
    const Stamp from = odometry[first].stamp;
    const Stamp to = odometry[last].stamp;
    Way way{.samples = {{first, last}},
            .begin = comparison.alignment(from, std::min(to, from.later(kEnd_s))),
            .end = comparison.alignment(std::max(from, to.later(-kEnd_s)), to),
            .length_m = comparison.length_m(first, last),
            .first_part = parts[first],
            .last_part = parts[last]};
    if (way.length_m >= kShortest_m && way.begin.weight_m > 0 && way.end.weight_m > 0) ways.push_back(way);
    first = last;
  }
  return ways;
}

/// How much better a way fits its neighbours in the direction that it has than in the other one.
double fit_of(const std::vector<Way>& ways, std::size_t i, std::span<const OdometrySample> odometry) {
  const double sign = ways[i].backwards ? -1 : 1;
  double fit = sign * kPreference * ways[i].length_m;
  const auto add = [&](const Way& earlier, const Way& later, const Way& other) {
    const double apart_s =
        seconds_between(odometry[earlier.samples.last].stamp, odometry[later.samples.first].stamp);
    if (apart_s > kFurthest_s || earlier.last_part != later.first_part) return;
    const double agree = (later.begin.turn * std::conj(earlier.end.turn)).real();
    fit += sign * (other.backwards ? -1 : 1) * agree * std::min(earlier.end.weight_m, later.begin.weight_m);
  };
  for (std::size_t back = 1; back <= 2; ++back) {
    if (i >= back) add(ways[i - back], ways[i], ways[i - back]);
    if (i + back < ways.size()) add(ways[i], ways[i + back], ways[i + back]);
  }
  return fit;
}

/// Extends a way to where its speed is least, before and after it: there the vehicle stands.
Reversing to_the_stops(Reversing way, std::span<const OdometrySample> odometry) {
  while (way.first > 0 && odometry[way.first - 1].speed_mps > 0 &&
         odometry[way.first - 1].speed_mps <= odometry[way.first].speed_mps)
    --way.first;
  while (way.last + 1 < odometry.size() && odometry[way.last + 1].speed_mps > 0 &&
         odometry[way.last + 1].speed_mps <= odometry[way.last].speed_mps)
    ++way.last;
  return way;
}

}  // namespace

std::vector<Reversing> find_reversing(std::span<const OdometrySample> odometry, std::span<const Fix> fixes) {
  const bool has_sign = std::any_of(odometry.begin(), odometry.end(),
                                    [](const OdometrySample& sample) { return sample.speed_mps < 0; });
  if (has_sign || fixes.empty()) return {};
  std::vector<Way> ways = ways_of(odometry, comparison_without_drift(odometry, fixes));
  // Each turn makes the whole fit better, so that the loop ends.
  for (std::size_t turns = 0; turns < ways.size(); ++turns) {
    std::size_t worst = ways.size();
    double least = 0;
    for (std::size_t i = 0; i < ways.size(); ++i) {
      const double fit = fit_of(ways, i, odometry);
      if (fit >= least) continue;
      least = fit;
      worst = i;
    }
    if (worst == ways.size()) break;
    ways[worst].backwards = !ways[worst].backwards;
  }
  std::vector<Reversing> found;
  for (const Way& way : ways)
    if (way.backwards) found.push_back(to_the_stops(way.samples, odometry));
  return found;
}

void drive_backwards(std::span<const Reversing> found, std::span<OdometrySample> odometry) {
  const bool is_derived = yaw_rate_at_rest(odometry).is_derived();
  for (const Reversing& time : found) {
    for (OdometrySample& sample : time.of(odometry)) {
      sample.speed_mps = -sample.speed_mps;
      if (is_derived) sample.yaw_rate_radps = -sample.yaw_rate_radps;
    }
  }
}

std::string warning_of(std::span<const Reversing> found, std::span<const OdometrySample> odometry) {
  std::string times;
  constexpr std::size_t kMost = 5;
  for (std::size_t i = 0; i < std::min(found.size(), kMost); ++i)
    times += fmt::format("{}{:.1f} to {:.1f} s", i == 0 ? "" : ", ",
                         seconds_between(odometry.front().stamp, odometry[found[i].first].stamp),
                         seconds_between(odometry.front().stamp, odometry[found[i].last].stamp));
  if (found.size() > kMost) times += fmt::format(" and {} more times", found.size() - kMost);
  return fmt::format(
      "no speed of the odometry is negative, but the fixes move backwards {} after its start: the vehicle is "
      "taken to reverse there; give the speed its sign (a column or signal of the gear or the direction)",
      times);
}

}  // namespace waymark::drive
