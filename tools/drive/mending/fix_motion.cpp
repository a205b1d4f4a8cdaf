#include <waymark/tools/drive/mending/fix_motion.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <waymark/types_se2/se2.hpp>

namespace waymark::drive {
namespace {

constexpr double kHalfChord_s = 2.5;
constexpr double kHalfTurn_s = 1.5;
constexpr double kDirection_m = 5;

}  // namespace

std::vector<Fix> fixes_for_motion(std::span<const Fix> fixes) {
  std::vector<Fix> kept;
  for (const Fix& fix : fixes)
    if (fix.source == fixes.front().source && fix.status != FixStatus::withheld) kept.push_back(fix);
  return kept;
}

Stamp MotionOfFixes::clamped(Stamp at) const {
  return std::clamp(at, fixes_.front().stamp, fixes_.back().stamp);
}

MotionOfFixes::Neighbours MotionOfFixes::around(Stamp at) const {
  const Stamp inside = clamped(at);
  const auto right = std::lower_bound(fixes_.begin(), fixes_.end(), inside,
                                      [](const Fix& fix, Stamp stamp) { return fix.stamp < stamp; });
  if (right == fixes_.begin()) return {*right, *right, 0};
  const Fix& left = *(right - 1);
  return {left, *right, seconds_between(left.stamp, inside) / seconds_between(left.stamp, right->stamp)};
}

Eigen::Vector2d MotionOfFixes::position(Stamp at) const {
  const auto [left, right, share] = around(at);
  return (1 - share) * left.position + share * right.position;
}

MotionOfFixes::TimedChord MotionOfFixes::chord_at(Stamp at) const {
  const Stamp from = clamped(at.later(-kHalfChord_s));
  const Stamp to = clamped(at.later(kHalfChord_s));
  return {position(to) - position(from), seconds_between(from, to)};
}

double MotionOfFixes::speed(Stamp at) const {
  const auto [left, right, share] = around(at);
  // Speeds over ground have no sense: a negative one is a mark of a receiver that does not know it.
  const auto is_known = [](const Fix& fix) { return fix.speed_mps && *fix.speed_mps >= 0; };
  if (is_known(left) && is_known(right)) return (1 - share) * *left.speed_mps + share * *right.speed_mps;
  const auto [chord, duration_s] = chord_at(at);
  return duration_s > 0 ? chord.norm() / duration_s : 0;
}

double MotionOfFixes::yaw_rate(Stamp at) const {
  const Eigen::Vector2d before = chord_at(at.later(-kHalfTurn_s)).chord;
  const Eigen::Vector2d after = chord_at(at.later(kHalfTurn_s)).chord;
  if (before.norm() < kDirection_m || after.norm() < kDirection_m) return 0;
  return angle_between(before, after) / (2 * kHalfTurn_s);
}

bool MotionOfFixes::covers(Stamp from, Stamp to) const {
  constexpr double kApart_s = 5;
  Stamp last = from;
  for (const Fix& fix : fixes_) {
    if (fix.stamp < from) continue;
    if (seconds_between(last, std::min(fix.stamp, to)) > kApart_s) return false;
    last = fix.stamp;
    if (last >= to) return true;
  }
  return seconds_between(last, to) <= kApart_s;
}

std::size_t fill_gaps(std::vector<OdometrySample>& odometry, std::span<const Fix> fixes, double gap_s) {
  constexpr double kShortest_s = 2;
  constexpr double kPeriod_s = 0.5;
  const MotionOfFixes motion(fixes);
  std::vector<OdometrySample> filled;
  filled.reserve(odometry.size());
  std::size_t gaps = 0;
  for (const OdometrySample& sample : odometry) {
    const double length_s = filled.empty() ? 0 : seconds_between(filled.back().stamp, sample.stamp);
    if (length_s > gap_s && length_s >= kShortest_s && motion.covers(filled.back().stamp, sample.stamp)) {
      ++gaps;
      const Stamp begin = filled.back().stamp;
      const int parts = static_cast<int>(std::ceil(length_s / kPeriod_s));
      for (int part = 1; part < parts; ++part) {
        const Stamp at = begin.later(part * length_s / parts);
        filled.push_back({at, motion.speed(at), motion.yaw_rate(at), true});
      }
    }
    filled.push_back(sample);
  }
  odometry = std::move(filled);
  return gaps;
}

}  // namespace waymark::drive
