#include <waymark/tools/drive/mending/carried.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <waymark/tools/drive/mending/fix_motion.hpp>

namespace waymark::drive {
namespace {

constexpr double kShortestCarry_s = 10;
constexpr double kRests_mps = 0.1;
constexpr double kCarryShare = 0.25;  // of the distance, by which fixes on one side may differ

/// The way of an odometry up to each of its samples.
class Ways {
 public:
  explicit Ways(std::span<const OdometrySample> odometry) : odometry_(odometry) {
    ways_m_.push_back(0);
    for (std::size_t i = 1; i < odometry.size(); ++i) {
      const double mean_mps = 0.5 * (std::abs(odometry[i - 1].speed_mps) + std::abs(odometry[i].speed_mps));
      ways_m_.push_back(ways_m_.back() +
                        mean_mps * seconds_between(odometry[i - 1].stamp, odometry[i].stamp));
    }
  }
  [[nodiscard]] std::size_t first_after(Stamp stamp) const {
    const auto at =
        std::lower_bound(odometry_.begin(), odometry_.end(), stamp,
                         [](const OdometrySample& of, Stamp moment) { return of.stamp < moment; });
    return static_cast<std::size_t>(at - odometry_.begin());
  }
  [[nodiscard]] double between_m(const Fix& a, const Fix& b) const { return way_m(b.stamp) - way_m(a.stamp); }

 private:
  [[nodiscard]] double way_m(Stamp stamp) const {
    return ways_m_[std::min(first_after(stamp), odometry_.size() - 1)];
  }
  std::span<const OdometrySample> odometry_;
  std::vector<double> ways_m_;
};

/// Returns the longest time of rest between two moments.
std::optional<SampleRange> longest_rest(std::span<const OdometrySample> odometry, const Ways& ways,
                                        Stamp from, Stamp to) {
  std::optional<SampleRange> longest;
  const std::size_t end = ways.first_after(to);
  for (std::size_t i = ways.first_after(from); i < end; ++i) {
    if (std::abs(odometry[i].speed_mps) >= kRests_mps) continue;
    SampleRange rest{i, i};
    while (i + 1 < end && std::abs(odometry[i + 1].speed_mps) < kRests_mps) rest.last = ++i;
    if (!longest || rest.duration_s(odometry) > longest->duration_s(odometry)) longest = rest;
  }
  return longest && longest->duration_s(odometry) >= kShortestCarry_s ? longest : std::nullopt;
}

/// Tells whether the next fixes on one side of a fix are where the odometry may have them.
/// @param step -1: before it, 1: after it
bool are_with(const std::vector<Fix>& fixes, std::size_t at, int step, double tolerance_m, const Ways& ways) {
  constexpr int kFixes = 3;
  constexpr double kLongest_s = 60;
  int near = 0;
  for (auto i = static_cast<std::ptrdiff_t>(at) + step; near < kFixes; i += step) {
    if (i < 0 || i >= std::ssize(fixes)) return false;
    const Fix& other = fixes[static_cast<std::size_t>(i)];
    if (std::abs(seconds_between(fixes[at].stamp, other.stamp)) > kLongest_s) return false;
    const double chord_m = (other.position - fixes[at].position).norm();
    if (chord_m > std::abs(ways.between_m(fixes[at], other)) + tolerance_m) return false;
    ++near;
  }
  return true;
}

}  // namespace

std::vector<Carried> find_carried(std::span<const OdometrySample> odometry, std::span<const Fix> fixes) {
  constexpr double kSmallest_m = 100;
  constexpr double kSigmas = 10;
  std::vector<Carried> found;
  if (odometry.empty()) return found;
  const std::vector<Fix> all = fixes_for_motion(fixes);
  const Ways ways(odometry);
  for (std::size_t i = 1; i < all.size(); ++i) {
    const Fix& before = all[i - 1];
    const Fix& after = all[i];
    if (seconds_between(before.stamp, after.stamp) < kShortestCarry_s) continue;
    const double away_m = (after.position - before.position).norm() - ways.between_m(before, after);
    if (away_m < std::max(kSmallest_m, kSigmas * std::max(before.accuracy_m(), after.accuracy_m()))) continue;
    if (!are_with(all, i - 1, -1, kCarryShare * away_m, ways) ||
        !are_with(all, i, 1, kCarryShare * away_m, ways))
      continue;
    if (const auto rest = longest_rest(odometry, ways, before.stamp, after.stamp))
      found.push_back({*rest, away_m});
  }
  return found;
}

std::string warning_of(const Carried& carried, std::span<const OdometrySample> odometry, Stamp start) {
  return fmt::format(
      "the odometry stands from {:.1f} s to {:.1f} s after its start, and the fixes around it are {:.0f} m further "
      "apart than its way: the vehicle was carried (ferry, train, tow truck), so the odometry is left out there; if "
      "it was not, the fixes on one side are wrong",
      seconds_between(start, odometry[carried.first].stamp),
      seconds_between(start, odometry[carried.last].stamp), carried.distance_m);
}

}  // namespace waymark::drive
