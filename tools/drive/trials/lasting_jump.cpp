#include <waymark/tools/drive/trials/lasting_jump.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>

#include <fmt/format.h>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/tools/drive/trials/trial_drive.hpp>

namespace waymark::drive {
namespace {

/// Fixes lie for so long on each side. Reflections make jumps as well, and are gone after such a time.
constexpr double kSide_s = 120;
/// What is left of the fixes is compared over so long on each side: the nearer, the less the poses have followed them.
constexpr double kNear_s = 10;
constexpr std::size_t kFewestNear = 5;

/// Returns the mean of what is left over a time and a number of fixes, from one on, forwards (step 1) or backwards.
Eigen::Vector2d mean_from(std::size_t first, int step, double duration_s, const LeftOfFixes& left) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  std::size_t count = 0;
  for (auto i = static_cast<std::ptrdiff_t>(first); i >= 0 && i < std::ssize(left.stamps); i += step) {
    const auto at = static_cast<std::size_t>(i);
    if (count >= kFewestNear && std::abs(seconds_between(left.stamps[first], left.stamps[at])) > duration_s)
      break;
    sum += left.off_m[at];
    ++count;
  }
  return sum / static_cast<double>(count);
}

/// Returns what changes from the fixes before one to it and those after it.
Eigen::Vector2d change_at(std::size_t i, double duration_s, const LeftOfFixes& left) {
  return mean_from(i, 1, duration_s, left) - mean_from(i - 1, -1, duration_s, left);
}

/// Tells whether the fixes before and from a moment on last long enough, up to the known jumps of their receiver.
bool has_sides(Stamp at, int source, const LeftOfFixes& left, std::span<const LastingJump> known) {
  if (seconds_between(left.stamps.front(), at) < kSide_s || seconds_between(at, left.stamps.back()) < kSide_s)
    return false;
  return std::none_of(known.begin(), known.end(), [&](const LastingJump& jump) {
    return jump.source == source && std::abs(seconds_between(jump.at, at)) < kSide_s;
  });
}

/// Returns the places at which what is left changes most, the largest change first.
std::vector<LastingJump> candidates_of(int source, const LeftOfFixes& left,
                                       std::span<const LastingJump> known) {
  constexpr double kUnusual = 4;  // of the median; of a normal distribution in the plane once in 60,000 times
  constexpr std::size_t kMost = 3;
  constexpr std::size_t kFewestChanges = 20;
  std::vector<LastingJump> changes;
  std::vector<double> sizes;
  for (std::size_t i = 1; i < left.stamps.size(); ++i) {
    if (!has_sides(left.stamps[i], source, left, known)) continue;
    changes.push_back({source, left.stamps[i], change_at(i, kNear_s, left)});
    sizes.push_back(changes.back().by.norm());
  }
  if (changes.size() < kFewestChanges) return {};
  const double least_m = kUnusual * upper_median(std::move(sizes));
  std::stable_sort(changes.begin(), changes.end(), [](const LastingJump& a, const LastingJump& b) {
    return a.by.squaredNorm() > b.by.squaredNorm();
  });
  std::vector<LastingJump> candidates;
  for (const LastingJump& change : changes) {
    if (candidates.size() == kMost || change.by.norm() < least_m) break;
    const bool is_beside = std::any_of(candidates.begin(), candidates.end(), [&](const LastingJump& other) {
      return std::abs(seconds_between(other.at, change.at)) < kNear_s;
    });
    if (!is_beside) candidates.push_back(change);
  }
  return candidates;
}

double cost_with(std::span<const LastingJump> known, const LastingJump& jump, TrialDrive& trial) {
  std::vector<LastingJump> all(known.begin(), known.end());
  all.push_back(jump);
  return trial.cost_with([&](PlacedDrive& drive) { take_jumps(all, drive.fixes); });
}

/// Returns the cost with another level between two moments alone, beside those of the known jumps.
double cost_between(Stamp from, Stamp to, std::span<const LastingJump> known, const LastingJump& jump,
                    TrialDrive& trial) {
  return trial.cost_with([&](PlacedDrive& drive) {
    for (Fix& fix : drive.fixes) {
      if (fix.source != jump.source || fix.stamp < from || to <= fix.stamp) continue;
      fix.level = static_cast<int>(known.size()) + 1;
      fix.jump_sigma_m = 0.5 * jump.by.norm();
    }
  });
}

/// Returns by how much half chi2 has to fall.
double gain_of(double cost, const TrialDrive& trial) {
  constexpr double kGain = 15;
  return kGain * std::pow(trial.spread(cost), 2);
}

/// Tells whether a jump that lasts is more probable than fixes that are elsewhere for some time before or after it.
bool lasts(const LastingJump& jump, std::span<const LastingJump> known, double cost, TrialDrive& trial) {
  return std::min(cost_between(jump.at, jump.at.later(kSide_s), known, jump, trial),
                  cost_between(jump.at.later(-kSide_s), jump.at, known, jump, trial)) >
         cost + gain_of(cost, trial);
}

/// The poses of a drive without the jump go along with it, so that it looks smaller.
LastingJump wider(LastingJump jump) {
  constexpr double kLooksSmaller = 2;
  jump.by *= kLooksSmaller;
  return jump;
}

/// Measures a jump with the poses of a drive that has it. One that was taken for smaller still bends them.
LastingJump measured(LastingJump jump, std::span<const LastingJump> known, TrialDrive& trial) {
  constexpr double kFar_s = 30;
  constexpr double kSame = 1.1;
  constexpr int kMostRounds = 5;
  for (int round = 0; round < kMostRounds; ++round) {
    const double before_m = jump.by.norm();
    (void)cost_with(known, wider(jump), trial);
    const LeftOfFixes left = trial.left_of(jump.source);
    const auto at = std::find(left.stamps.begin(), left.stamps.end(), jump.at);
    jump.by = change_at(static_cast<std::size_t>(at - left.stamps.begin()), kFar_s, left);
    if (jump.by.norm() < kSame * before_m) break;
  }
  return jump;
}

/// A coarse drive has only some of the fixes: the jump is at the first of all that are nearer to those after it.
Stamp first_elsewhere(const LastingJump& jump, const PlacedDrive& placed, const TrialDrive& trial) {
  const std::vector<Fix>& coarse = trial.drive().fixes;
  const auto is_of = [&](const Fix& fix) {
    return fix.source == jump.source && fix.status == FixStatus::accepted;
  };
  std::size_t before = coarse.size();
  std::size_t after = 0;
  while (after < coarse.size() && !(is_of(coarse[after]) && coarse[after].stamp >= jump.at)) {
    if (is_of(coarse[after])) before = after;
    ++after;
  }
  if (before == coarse.size() || after == coarse.size()) return jump.at;
  const Eigen::Vector2d from = coarse[before].position - trial.left_of_fix(before);
  const Eigen::Vector2d to = coarse[after].position - trial.left_of_fix(after);
  const double apart_s = seconds_between(coarse[before].stamp, coarse[after].stamp);
  for (const Fix& fix : placed.fixes) {
    if (!is_of(fix) || fix.stamp <= coarse[before].stamp || fix.stamp >= coarse[after].stamp) continue;
    const double share = seconds_between(coarse[before].stamp, fix.stamp) / apart_s;
    const Eigen::Vector2d off = fix.position - (1 - share) * from - share * to;
    if ((off - trial.left_of_fix(after)).norm() < (off - trial.left_of_fix(before)).norm()) return fix.stamp;
  }
  return jump.at;
}

}  // namespace

std::optional<LastingJump> find_lasting_jump(const PlacedDrive& placed, std::span<const LastingJump> known,
                                             std::span<const PreparedSensor> sensors,
                                             const FusionSettings& settings, const TypeRegistry& registry,
                                             const std::function<void()>& between) {
  constexpr double kFixPeriod_s = 1;
  constexpr double kMostFixes = 2000;
  if (placed.fixes.empty()) return std::nullopt;
  const double duration_s = seconds_between(placed.fixes.front().stamp, placed.fixes.back().stamp);
  TrialDrive trial(coarsen(placed, sensors, std::max(kFixPeriod_s, duration_s / kMostFixes)), settings,
                   registry, between);
  std::vector<LastingJump> candidates;
  for (int source = 0; source < std::ssize(placed.receivers); ++source) {
    const LeftOfFixes left = trial.left_of(source);
    if (left.stamps.empty()) continue;
    for (const LastingJump& candidate : candidates_of(source, left, known)) candidates.push_back(candidate);
  }
  if (candidates.empty()) return std::nullopt;
  const double without = trial.cost_with([](PlacedDrive&) {});
  double least = without - gain_of(without, trial);
  std::optional<LastingJump> best;
  for (const LastingJump& candidate : candidates) {
    const double cost = cost_with(known, wider(candidate), trial);
    if (!(cost < least) || !lasts(wider(candidate), known, cost, trial)) continue;
    least = cost;
    best = candidate;
  }
  if (!best) return std::nullopt;
  best = measured(*best, known, trial);
  best->at = first_elsewhere(*best, placed, trial);
  return best;
}

void take_jumps(std::span<const LastingJump> jumps, std::span<Fix> fixes) {
  std::map<int, std::vector<LastingJump>> of_source;
  for (const LastingJump& jump : jumps) of_source[jump.source].push_back(jump);
  for (auto& [source, own] : of_source)
    std::sort(own.begin(), own.end(), [](const LastingJump& a, const LastingJump& b) { return a.at < b.at; });
  for (Fix& fix : fixes) {
    const std::vector<LastingJump>& own = of_source[fix.source];
    const auto after = std::upper_bound(own.begin(), own.end(), fix.stamp,
                                        [](Stamp stamp, const LastingJump& jump) { return stamp < jump.at; });
    const double before_m = after == own.begin() ? 0 : std::prev(after)->by.norm();
    const double after_m = after == own.end() ? 0 : after->by.norm();
    fix.level = static_cast<int>(after - own.begin());
    fix.jump_sigma_m = 0.5 * std::max(before_m, after_m);
  }
}

std::string warning_of(const LastingJump& jump, const std::string& receiver, Stamp first) {
  return fmt::format(
      "the fixes of '{}' lie {:.2g} m elsewhere ({:+.2g} m east, {:+.2g} m north) from {:.1f} s after the first fix on, "
      "and the odometry does not move so: corrections that were lost, or another reference. The drive does not tell "
      "which side is right, so the result lies between both, and its covariances contain that; leave the wrong side "
      "out, by 'time: {{from, to}}', if you know it",
      receiver, jump.by.norm(), jump.by.x(), jump.by.y(), seconds_between(first, jump.at));
}

}  // namespace waymark::drive
