#include <waymark/tools/drive/mending/standing.hpp>

#include <algorithm>
#include <cmath>

namespace waymark::drive {
namespace {

constexpr double kSlow_mps = 0.5;
constexpr double kWindow_s = 3;
constexpr std::size_t kFewestInWindow = 15;
constexpr double kNoise = 0.4;  // change from sample to sample over speed

/// Sums over the samples before each one.
struct Sums {
  std::vector<double> speed{0};
  std::vector<double> change{0};
  std::vector<std::size_t> fast{0};
};

Sums sums_of(std::span<const OdometrySample> odometry) {
  Sums sums;
  for (std::size_t i = 0; i < odometry.size(); ++i) {
    const double speed = odometry[i].speed_mps;
    sums.speed.push_back(sums.speed.back() + speed);
    sums.change.push_back(sums.change.back() + (i == 0 ? 0 : std::abs(speed - odometry[i - 1].speed_mps)));
    sums.fast.push_back(sums.fast.back() + (speed < kSlow_mps ? 0 : 1));
  }
  return sums;
}

/// Tells whether samples [first, last] are noise about 0.
bool is_noise(const Sums& sums, std::size_t first, std::size_t last) {
  if (last - first + 1 < kFewestInWindow || sums.fast[last + 1] > sums.fast[first]) return false;
  return sums.change[last + 1] - sums.change[first + 1] > kNoise * (sums.speed[last + 1] - sums.speed[first]);
}

}  // namespace

std::vector<Standing> find_standing(std::span<const OdometrySample> odometry) {
  const bool has_sign = std::any_of(odometry.begin(), odometry.end(),
                                    [](const OdometrySample& sample) { return sample.speed_mps < 0; });
  if (has_sign) return {};
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
      found.push_back({first, last});
    }
  }
  return found;
}

}  // namespace waymark::drive
