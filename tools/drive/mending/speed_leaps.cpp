#include <waymark/tools/drive/mending/speed_leaps.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <waymark/core/base/detail/median.hpp>

namespace waymark::drive {
namespace {

constexpr double kImpossible = 15;  // m/s^2, beyond what tyres hold
constexpr double kPossible = 10;    // m/s^2
constexpr double kSigmas = 8;

/// The speeds of the odometry, and what is usual from one to the next.
class Speeds {
 public:
  explicit Speeds(std::span<const OdometrySample> odometry) : odometry_(odometry) {
    std::vector<double> changes;
    for (std::size_t i = 1; i < odometry.size(); ++i)
      if (std::abs(odometry[i].speed_mps) > kLeastLeap_mps) changes.push_back(std::abs(change(i - 1, i)));
    if (!changes.empty()) usual_ = 1.4826 * upper_median(std::move(changes));
  }

  [[nodiscard]] double change(std::size_t from, std::size_t to) const {
    return odometry_[to].speed_mps - odometry_[from].speed_mps;
  }
  [[nodiscard]] double time_s(std::size_t from, std::size_t to) const {
    return seconds_between(odometry_[from].stamp, odometry_[to].stamp);
  }
  [[nodiscard]] bool leaps(std::size_t from, std::size_t to) const {
    return is_speed_leap(change(from, to), time_s(from, to), usual_);
  }

  /// Returns the sample to which the speed leaps from `from`, if it does.
  [[nodiscard]] std::optional<std::size_t> leap_after(std::size_t from) const {
    for (std::size_t to = from + 1; to < odometry_.size(); ++to) {
      if (leaps(from, to)) return to;
      if (time_s(from, to) > kLeapTakes_s) break;
    }
    return std::nullopt;
  }

  /// Returns the sample at which a speed is back that leapt away from `base` to `away`, if it comes back.
  [[nodiscard]] std::optional<std::size_t> back_after(std::size_t base, std::size_t away) const {
    for (std::size_t at = away + 1; at < odometry_.size() && time_s(base, at) <= kLeapLasts_s; ++at) {
      if (!is_possible_change(change(base, at), time_s(base, at)) || !leaps_back(base, away, at)) continue;
      return end_of_leap(at, change(base, away) < 0);
    }
    return std::nullopt;
  }

 private:
  /// Tells whether the speed leaps to `at` against the change from `base` to `away`.
  [[nodiscard]] bool leaps_back(std::size_t base, std::size_t away, std::size_t at) const {
    for (std::size_t from = at; from-- > away;) {
      if (leaps(from, at) && change(from, at) * change(base, away) < 0) return true;
      if (time_s(from, at) > kLeapTakes_s) break;
    }
    return false;
  }
  /// The speed may still be on its way.
  [[nodiscard]] std::size_t end_of_leap(std::size_t at, bool rises) const {
    while (at + 1 < odometry_.size()) {
      const double further = rises ? change(at, at + 1) : -change(at, at + 1);
      if (further <= kImpossible * time_s(at, at + 1) + usual_) break;
      ++at;
    }
    return at;
  }

  std::span<const OdometrySample> odometry_;
  double usual_ = 0;  ///< m/s, standard deviation of a change
};

}  // namespace

bool is_speed_leap(double change_mps, double time_s, double usual_mps) {
  return std::abs(change_mps) > kLeastLeap_mps + kImpossible * time_s + kSigmas * usual_mps;
}

bool is_possible_change(double change_mps, double time_s) {
  return std::abs(change_mps) <= 1 + kPossible * time_s;
}

std::vector<SpeedLeap> find_speed_leaps(std::span<const OdometrySample> odometry) {
  constexpr std::size_t kRare = 20;
  const Speeds speeds(odometry);
  std::vector<SpeedLeap> found;
  std::size_t samples = 0;
  for (std::size_t base = 0; base + 2 < odometry.size(); ++base) {
    const std::optional<std::size_t> away = speeds.leap_after(base);
    if (!away) continue;
    const std::optional<std::size_t> back = speeds.back_after(base, *away);
    if (!back) continue;
    found.push_back({{base + 1, *back - 1}});
    samples += found.back().size();
    base = *back - 1;
  }
  if (kRare * samples > odometry.size()) found.clear();
  return found;
}

void bridge_speed_leaps(std::span<const SpeedLeap> leaps, std::span<OdometrySample> odometry) {
  for (const SpeedLeap& leap : leaps) {
    const OdometrySample& before = odometry[leap.first - 1];
    const OdometrySample& after = odometry[leap.last + 1];
    const double length_s = seconds_between(before.stamp, after.stamp);
    for (OdometrySample& sample : leap.of(odometry)) {
      const double share = seconds_between(before.stamp, sample.stamp) / length_s;
      sample.speed_mps = before.speed_mps + share * (after.speed_mps - before.speed_mps);
      sample.assumed = true;
    }
  }
}

std::string warning_of(std::span<const SpeedLeap> leaps, std::span<const OdometrySample> odometry) {
  double total_s = 0;
  for (const SpeedLeap& leap : leaps)
    total_s += seconds_between(odometry[leap.first - 1].stamp, odometry[leap.last + 1].stamp);
  const SpeedLeap& first = leaps.front();
  return fmt::format(
      "the speed of the odometry leaps away and back faster than a vehicle accelerates, in {} {} of {:.1f} s "
      "together, the first {:.1f} s after its start from {:.3g} to {:.3g} m/s: wheels that lock or spin, or "
      "wrong readings; the speed around them is assumed there, with the noise of a gap",
      leaps.size(), leaps.size() == 1 ? "place" : "places", total_s,
      seconds_between(odometry.front().stamp, odometry[first.first].stamp),
      odometry[first.first - 1].speed_mps, odometry[(first.first + first.last + 1) / 2].speed_mps);
}

}  // namespace waymark::drive
