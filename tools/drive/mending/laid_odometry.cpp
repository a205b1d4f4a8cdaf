#include <waymark/tools/drive/mending/laid_odometry.hpp>

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/tools/drive/logs/time_series.hpp>
#include <waymark/tools/drive/mending/fix_motion.hpp>
#include <waymark/tools/drive/nodes/yaw_rate_at_rest.hpp>

namespace waymark::drive {
namespace {

using Complex = std::complex<double>;

/// Longer intervals between samples are silences.
double silence_of(std::span<const OdometrySample> odometry) {
  constexpr double kSilence_s = 2;
  return longest_silence_s(series_of({odometry.begin(), odometry.end()}, &OdometrySample::speed_mps),
                           kSilence_s);
}

double median_yaw_rate_at_rest(std::span<const OdometrySample> odometry) {
  constexpr double kRests = 0.05;  // m/s
  if (!yaw_rate_at_rest(odometry).is_known()) return 0;
  std::vector<double> readings;
  for (const OdometrySample& sample : odometry)
    if (std::abs(sample.speed_mps) < kRests) readings.push_back(sample.yaw_rate_radps);
  return upper_median(std::move(readings));
}

Complex complex_of(const Fix& fix) {
  return {fix.position.x(), fix.position.y()};
}

/// Sums of places beside each other, about their means.
struct Moments {
  Complex middle_of_fixes;
  Complex middle_of_odometry;
  Complex product;  ///< of the fixes with the conjugates of the odometry
  double fixes = 0;
  double odometry = 0;
};

Moments moments_of(std::span<const Fix> fixes, std::span<const Complex> places) {
  Complex middle_of_fixes;
  Complex middle_of_odometry;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    middle_of_fixes += complex_of(fixes[i]);
    middle_of_odometry += places[i];
  }
  middle_of_fixes /= static_cast<double>(fixes.size());
  middle_of_odometry /= static_cast<double>(fixes.size());
  Moments sums{middle_of_fixes, middle_of_odometry, {}, 0, 0};
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    const Complex fix = complex_of(fixes[i]) - middle_of_fixes;
    const Complex reckoned = places[i] - middle_of_odometry;
    sums.product += fix * std::conj(reckoned);
    sums.fixes += std::norm(fix);
    sums.odometry += std::norm(reckoned);
  }
  return sums;
}

}  // namespace

LaidOdometry::LaidOdometry(std::span<const OdometrySample> odometry, std::span<const Fix> fixes)
    : odometry_(odometry), fixes_(fixes_for_motion(fixes)), silence_s_(silence_of(odometry)) {
  drift_.radps = median_yaw_rate_at_rest(odometry);
  reckon();
}

LaidOdometry LaidOdometry::without_drift(std::span<const OdometrySample> odometry,
                                         std::span<const Fix> fixes) {
  constexpr int kTimes = 2;  // the second time with straighter pieces
  LaidOdometry laid(odometry, fixes);
  const bool has_bias = !yaw_rate_at_rest(odometry).is_derived();
  for (int k = 0; k < kTimes; ++k) laid.remove(drift_of(laid.drifted(), has_bias));
  return laid;
}

bool LaidOdometry::stays(Stamp from, Stamp to) const {
  const auto after = first_since(to);
  const auto later = std::upper_bound(fixes_.begin(), fixes_.end(), from,
                                      [](Stamp stamp, const Fix& fix) { return stamp < fix.stamp; });
  if (after == fixes_.end() || later == fixes_.begin()) return false;
  const Fix& before = *std::prev(later);
  return (after->position - before.position).norm() <= after->accuracy_m() + before.accuracy_m();
}

bool LaidOdometry::is_silent_before(std::size_t sample) const {
  return seconds_between(odometry_[sample - 1].stamp, odometry_[sample].stamp) > silence_s_;
}

double LaidOdometry::length_m(std::size_t first, std::size_t last) const {
  double length = 0;
  for (std::size_t i = first + 1; i <= last; ++i) length += std::abs(positions_[i] - positions_[i - 1]);
  return length;
}

LaidTime LaidOdometry::alignment(Stamp from, Stamp to) const {
  constexpr std::size_t kFewestFixes = 3;
  constexpr double kLargestFactor = 1.6;
  constexpr double kCoherence = 0.9;
  constexpr double kSpread_m = 1.5;  // of 5 m of way
  constexpr double kHeaviest_m = 100;
  const auto [during, places] = pairs(from, to);
  if (during.size() < kFewestFixes) return {};
  double accuracy_m = 0;
  for (const Fix& fix : during) accuracy_m = std::max(accuracy_m, fix.accuracy_m());
  const Moments sums = moments_of(during, places);
  const double spread_m = std::sqrt(sums.odometry / static_cast<double>(during.size()));
  const double factor = std::sqrt(sums.fixes / sums.odometry);
  const bool is_clear = std::abs(sums.product) >= kCoherence * std::sqrt(sums.fixes * sums.odometry) &&
                        factor < kLargestFactor && factor > 1 / kLargestFactor;
  if (spread_m < std::max(kSpread_m, 0.5 * accuracy_m) || !is_clear) return {};
  return {sums.product / std::abs(sums.product), std::min(kHeaviest_m, std::sqrt(12.0) * spread_m)};
}

std::optional<double> LaidOdometry::displacement_m(Stamp from, Stamp to) const {
  constexpr double kBeside_s = 20;
  constexpr double kSettles_s = 5;  // what a receiver needs to come back
  constexpr std::size_t kFewestFixes = 4;
  constexpr double kCoherence = 0.95;
  const Pairs before = pairs(from.later(-kBeside_s), from);
  const Pairs after = pairs(to.later(kSettles_s), to.later(kSettles_s + kBeside_s));
  if (std::min(before.fixes.size(), after.fixes.size()) < kFewestFixes) return std::nullopt;
  const Moments first = moments_of(before.fixes, before.places);
  const Moments last = moments_of(after.fixes, after.places);
  const Complex product = first.product + last.product;
  const double both = std::sqrt((first.fixes + last.fixes) * (first.odometry + last.odometry));
  if (!(both > 0) || std::abs(product) < kCoherence * both) return std::nullopt;
  const Complex turn = product / std::abs(product);
  return std::abs(last.middle_of_fixes - first.middle_of_fixes -
                  turn * (last.middle_of_odometry - first.middle_of_odometry));
}

LaidOdometry::Pairs LaidOdometry::pairs(Stamp from, Stamp to) const {
  Pairs result{{first_since(from), first_since(to)}, {}};
  for (const Fix& fix : result.fixes) result.places.push_back(position_at(fix.stamp));
  return result;
}

/// Compares short times that follow each other while the vehicle moves and the odometry speaks. It does not matter
/// whether the vehicle reverses.
std::vector<LaidOdometry::Drifted> LaidOdometry::drifted() const {
  constexpr double kShort_s = 10;
  std::vector<Drifted> result;
  LaidTime before;
  std::size_t first_before = 0;
  for (std::size_t first = 0; first < odometry_.size();) {
    std::size_t last = first;
    bool moves = true;
    while (last + 1 < odometry_.size() &&
           seconds_between(odometry_[first].stamp, odometry_[last].stamp) < kShort_s) {
      ++last;
      moves = moves && odometry_[last].speed_mps >= kMoves_mps && !is_silent_before(last);
    }
    if (last == first) break;
    const LaidTime here = moves ? alignment(odometry_[first].stamp, odometry_[last].stamp) : LaidTime{};
    if (here.weight_m > 0 && before.weight_m > 0)
      result.push_back({-std::arg(here.turn * std::conj(before.turn)),
                        0.5 * seconds_between(odometry_[first_before].stamp, odometry_[last].stamp),
                        0.5 * length_m(first_before, last)});
    before = here;
    first_before = first;
    first = last;
  }
  return result;
}

/// Returns the drift that explains the turns with the least sum of remainders, near none if they do not tell it.
/// @param has_bias false: only turns per metre
YawDrift LaidOdometry::drift_of(std::span<const Drifted> turns, bool has_bias) {
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

void LaidOdometry::remove(const YawDrift& more) {
  drift_.radps += more.radps;
  drift_.radpm += more.radpm;
  reckon();
}

void LaidOdometry::reckon() {
  positions_.assign(1, {});
  double heading = 0;
  for (std::size_t i = 1; i < odometry_.size(); ++i) {
    const OdometrySample& a = odometry_[i - 1];
    const OdometrySample& b = odometry_[i];
    const double dt = seconds_between(a.stamp, b.stamp);
    const double length = 0.5 * dt * (a.speed_mps + b.speed_mps);
    const double turn =
        dt * (0.5 * (a.yaw_rate_radps + b.yaw_rate_radps) - drift_.radps) - length * drift_.radpm;
    positions_.push_back(positions_.back() + std::polar(length, heading + 0.5 * turn));
    heading += turn;
  }
}

std::vector<Fix>::const_iterator LaidOdometry::first_since(Stamp moment) const {
  return std::lower_bound(fixes_.begin(), fixes_.end(), moment,
                          [](const Fix& fix, Stamp stamp) { return fix.stamp < stamp; });
}

Complex LaidOdometry::position_at(Stamp stamp) const {
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

}  // namespace waymark::drive
