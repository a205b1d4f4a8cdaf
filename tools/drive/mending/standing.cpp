#include <waymark/tools/drive/mending/standing.hpp>

#include <algorithm>
#include <cmath>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/tools/drive/mending/fix_motion.hpp>

namespace waymark::drive {
namespace {

constexpr double kSlow_mps = 0.5;
constexpr double kWindow_s = 3;
constexpr std::size_t kFewestInWindow = 15;
constexpr double kNoise = 0.4;         // change from sample to sample over speed
constexpr std::size_t kFewZeros = 10;  // at most one in 10

/// Sums over the samples before each one.
struct Sums {
  std::vector<double> way{0};  // speeds with their sign
  std::vector<double> speed{0};
  std::vector<double> change{0};
  std::vector<std::size_t> fast{0};
  std::vector<std::size_t> zero{0};
};

Sums sums_of(std::span<const OdometrySample> odometry) {
  Sums sums;
  for (std::size_t i = 0; i < odometry.size(); ++i) {
    const double speed = odometry[i].speed_mps;
    sums.way.push_back(sums.way.back() + speed);
    sums.speed.push_back(sums.speed.back() + std::abs(speed));
    sums.change.push_back(sums.change.back() + (i == 0 ? 0 : std::abs(speed - odometry[i - 1].speed_mps)));
    sums.fast.push_back(sums.fast.back() + (std::abs(speed) < kSlow_mps ? 0 : 1));
    sums.zero.push_back(sums.zero.back() + (speed == 0 ? 1 : 0));
  }
  return sums;
}

/// Tells whether samples [first, last] are noise about 0.
bool is_noise(const Sums& sums, std::size_t first, std::size_t last) {
  const std::size_t count = last - first + 1;
  if (count < kFewestInWindow || sums.fast[last + 1] > sums.fast[first]) return false;
  // noise is never exactly 0; readings that are have few digits
  if (kFewZeros * (sums.zero[last + 1] - sums.zero[first]) > count) return false;
  return sums.change[last + 1] - sums.change[first + 1] > kNoise * (sums.speed[last + 1] - sums.speed[first]);
}

/// Tells whether the fixes stay while the readings say that the vehicle creeps on.
bool fixes_stay(std::span<const Fix> fixes, Stamp from, Stamp to, double way_m) {
  constexpr double kShare = 0.4;
  constexpr std::size_t kEnd = 3;  // fixes whose median is an end
  std::vector<const Fix*> during;
  for (const Fix& fix : fixes)
    if (fix.stamp >= from && fix.stamp <= to) during.push_back(&fix);
  if (during.size() < 2 * kEnd) return false;
  const auto middle = [&](std::size_t first) {
    Eigen::Vector2d place;
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      std::vector<double> places;
      for (std::size_t i = first; i < first + kEnd; ++i) places.push_back(during[i]->position[axis]);
      place[axis] = upper_median(std::move(places));
    }
    return place;
  };
  const double moved_m = (middle(during.size() - kEnd) - middle(0)).norm();
  const double accuracy_m = during[during.size() / 2]->accuracy_m();
  return way_m > 3 * accuracy_m && moved_m < kShare * way_m;
}

}  // namespace

std::vector<Standing> find_standing(std::span<const OdometrySample> odometry, std::span<const Fix> fixes) {
  const Sums sums = sums_of(odometry);
  std::vector<Standing> found;
  std::size_t last = 0;
  for (std::size_t first = 0; first < odometry.size(); ++first) {
    const Stamp end = odometry[first].stamp.later(kWindow_s);
    last = std::max(last, first);
    while (last + 1 < odometry.size() && odometry[last + 1].stamp <= end) ++last;
    if (!is_noise(sums, first, last)) continue;
    if (!found.empty() && first <= found.back().last) {
      found.back().last = last;
    } else {
      found.push_back({{first, last}});
    }
  }
  if (found.empty()) return found;
  const std::vector<Fix> used = fixes_for_motion(fixes);
  std::erase_if(found, [&](const Standing& time) {
    const Stamp from = odometry[time.first].stamp;
    const Stamp to = odometry[time.last].stamp;
    const double mean = (sums.way[time.last + 1] - sums.way[time.first]) / static_cast<double>(time.size());
    return !fixes_stay(used, from, to, std::abs(mean) * time.duration_s(odometry));
  });
  return found;
}

}  // namespace waymark::drive
