#include <waymark/tools/drive/mending/factor_change.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>

#include <fmt/format.h>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/tools/drive/mending/fix_motion.hpp>
#include <waymark/tools/drive/mending/reckoned.hpp>

namespace waymark::drive {
namespace {

constexpr std::size_t kFewestLegs = 5;
constexpr double kShortestWay_m = 300;

/// The straight ways from one fix to a later one.
struct Leg {
  std::size_t from = 0;  ///< fix
  std::size_t to = 0;
  double fixes_m = 0;
  double odometry_m = 0;

  [[nodiscard]] double ratio() const { return fixes_m / odometry_m; }
  [[nodiscard]] double off() const { return std::abs(std::log(ratio())); }
};

std::vector<Leg> legs_of(const std::vector<Fix>& fixes, const std::vector<Complex>& places) {
  constexpr double kShortest_m = 60;
  constexpr double kAccuracies = 15;
  constexpr double kLongest_s = 60;
  constexpr double kMoves_m = 5;
  std::vector<Leg> legs;
  std::size_t from = 0;
  for (std::size_t to = 1; to < fixes.size(); ++to) {
    if (seconds_between(fixes[from].stamp, fixes[to].stamp) > kLongest_s) {
      from = to;
      continue;
    }
    const double least_m =
        std::max(kShortest_m, kAccuracies * std::max(fixes[from].accuracy_m(), fixes[to].accuracy_m()));
    const Leg leg{from, to, (fixes[to].position - fixes[from].position).norm(),
                  std::abs(places[to] - places[from])};
    if (leg.fixes_m < least_m || leg.odometry_m < kMoves_m) continue;
    legs.push_back(leg);
    from = to;
  }
  return legs;
}

double way_of(std::span<const Leg> legs) {
  double way_m = 0;
  for (const Leg& leg : legs) way_m += leg.fixes_m;
  return way_m;
}

/// Tells whether the legs that the odometry has right are enough to tell that it can be right.
bool is_right_elsewhere(std::span<const Leg> legs) {
  constexpr double kFine = 1.15;
  std::vector<Leg> fine;
  std::copy_if(legs.begin(), legs.end(), std::back_inserter(fine),
               [](const Leg& leg) { return leg.off() < std::log(kFine); });
  return fine.size() >= kFewestLegs && way_of(fine) >= kShortestWay_m;
}

/// Returns the factor on which legs agree; 1 if they do not.
double common_factor(std::span<const Leg> legs) {
  constexpr double kSame = 1.12;
  if (legs.size() < kFewestLegs || way_of(legs) < kShortestWay_m) return 1;
  std::vector<double> ratios;
  for (const Leg& leg : legs) ratios.push_back(leg.ratio());
  const double middle = upper_median(ratios);
  double fixes_m = 0;
  double odometry_m = 0;
  std::size_t agree = 0;
  for (const Leg& leg : legs) {
    if (std::abs(std::log(leg.ratio() / middle)) > std::log(kSame)) continue;
    ++agree;
    fixes_m += leg.fixes_m;
    odometry_m += leg.odometry_m;
  }
  return 5 * agree >= 4 * legs.size() ? fixes_m / odometry_m : 1;
}

/// Returns fixes at least a second apart, from one to another one.
std::vector<std::size_t> steps_between(std::size_t from, std::size_t to, const std::vector<Fix>& fixes) {
  constexpr double kApart_s = 0.9;
  std::vector<std::size_t> steps = {from};
  for (std::size_t i = from + 1; i <= to; ++i)
    if (seconds_between(fixes[steps.back()].stamp, fixes[i].stamp) > kApart_s) steps.push_back(i);
  return steps;
}

/// A wrong multiple from some moment on, or up to it.
struct Factors {
  double before = 1;
  double after = 1;
};

/// Returns the fix nearest to the change between two fixes: the steps of the odometry before and behind it, each with its
/// factor, are as those of the fixes.
std::size_t fix_at_change(std::size_t from, std::size_t to, const Factors& factors,
                          const std::vector<Fix>& fixes, const std::vector<Complex>& places) {
  const std::vector<std::size_t> steps = steps_between(from, to, fixes);
  double cost = 0;  // of a change at the last of them, less that of one at the first
  double least = 0;
  std::size_t best = from;
  for (std::size_t k = 1; k < steps.size(); ++k) {
    const double fixes_m = (fixes[steps[k]].position - fixes[steps[k - 1]].position).norm();
    const double odometry_m = std::abs(places[steps[k]] - places[steps[k - 1]]);
    cost += std::pow(fixes_m - factors.before * odometry_m, 2) -
            std::pow(fixes_m - factors.after * odometry_m, 2);
    if (cost >= least) continue;
    least = cost;
    best = steps[k];
  }
  return best;
}

/// Returns the first sample behind a change near a moment: the readings leap by the factors, if the vehicle moves.
std::size_t sample_at_change(Stamp about, const Factors& factors, std::span<const OdometrySample> odometry) {
  constexpr double kNear_s = 2.5;
  constexpr double kLikeIt = 0.5;
  constexpr double kMoves_mps = 0.2;
  const double leap = std::log(factors.before / factors.after);
  std::optional<std::size_t> nearest;
  std::size_t best = odometry.size();
  double least = kLikeIt * std::abs(leap);
  for (std::size_t i = 1; i < odometry.size(); ++i) {
    const double apart_s = seconds_between(about, odometry[i].stamp);
    if (!nearest && apart_s >= 0) nearest = i;
    const double before_mps = std::abs(odometry[i - 1].speed_mps);
    const double after_mps = std::abs(odometry[i].speed_mps);
    if (std::abs(apart_s) > kNear_s || before_mps < kMoves_mps || after_mps < kMoves_mps) continue;
    const double unlike = std::abs(std::log(after_mps / before_mps) - leap);
    if (unlike >= least) continue;
    least = unlike;
    best = i;
  }
  return best < odometry.size() ? best : nearest.value_or(odometry.size() - 1);
}

}  // namespace

std::vector<FactorChange> find_factor_changes(std::span<const OdometrySample> odometry,
                                              std::span<const Fix> fixes) {
  constexpr double kOff = 1.4;
  std::vector<FactorChange> found;
  std::vector<Fix> all = fixes_for_motion(fixes);
  if (odometry.size() < 2) return found;
  std::erase_if(all, [&](const Fix& fix) {
    return fix.stamp < odometry.front().stamp || fix.stamp > odometry.back().stamp;
  });
  if (all.empty()) return found;
  const std::vector<Complex> places = reckoned(odometry, all).places;
  const std::vector<Leg> legs = legs_of(all, places);
  if (!is_right_elsewhere(legs)) return found;
  for (std::size_t begin = 0; begin < legs.size(); ++begin) {
    std::size_t end = begin;
    while (end < legs.size() && legs[end].off() > std::log(kOff)) ++end;
    if (end == begin) continue;
    // The first and the last leg may lie across a change.
    const std::size_t first = begin + (begin > 0);
    const std::size_t last = end - (end < legs.size());
    const std::span<const Leg> inner = std::span(legs).subspan(first, std::max(first, last) - first);
    const double factor = common_factor(inner);
    if (std::abs(std::log(factor)) > std::log(kOff)) {
      const auto change_between = [&](const Leg& one, const Leg& next, const Factors& factors) {
        const std::size_t fix = fix_at_change(one.from, next.to, factors, all, places);
        return sample_at_change(all[fix].stamp, factors, odometry);
      };
      FactorChange change{{0, odometry.size() - 1}, factor, way_of(inner)};
      if (begin > 0) change.first = change_between(legs[begin - 1], legs[begin], {1, factor});
      if (end < legs.size()) change.last = change_between(legs[end - 1], legs[end], {factor, 1}) - 1;
      if (change.first < change.last) found.push_back(change);
    }
    begin = end;
  }
  return found;
}

void take_factors(std::span<const FactorChange> found, std::span<OdometrySample> odometry) {
  for (const FactorChange& change : found)
    for (OdometrySample& sample : change.of(odometry)) sample.speed_mps *= change.factor;
}

std::string warning_of(const FactorChange& change, std::span<const OdometrySample> odometry) {
  return fmt::format(
      "from {:.1f} s to {:.1f} s after the start of the odometry the fixes go {:.3g} times as far as it, {:.0f} m in all, "
      "and elsewhere as far as it: its speeds are multiplied by that there; check the unit of the speed, and its sensors",
      seconds_between(odometry.front().stamp, odometry[change.first].stamp),
      seconds_between(odometry.front().stamp, odometry[change.last].stamp), change.factor, change.way_m);
}

}  // namespace waymark::drive
