#include <waymark/tools/drive/sensors/rough_fixes.hpp>

#include <algorithm>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/tools/drive/logs/streams.hpp>

namespace waymark::drive {
namespace {

constexpr double kFarthest_m = 50'000;

Eigen::Vector3d middle_of(const std::vector<RoughPosition>& positions) {
  Eigen::Vector3d middle;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::vector<double> numbers;
    for (const RoughPosition& position : positions) numbers.push_back(position.ecef[axis]);
    middle[axis] = upper_median(numbers);
  }
  return middle;
}

}  // namespace

Fix rough_fix(const RoughPosition& position, const Projection& projection) {
  Fix fix;
  fix.stamp = position.stamp;
  const GridPoint place = projection.to_grid(geodetic_from_ecef(position.ecef));
  fix.position = place.position;
  fix.grid_scale = place.scale;
  fix.antenna_m = position.antenna_m;
  fix.covariance = position.sigma_m * position.sigma_m * Eigen::Matrix2d::Identity();
  return fix;
}

std::vector<Fix> rough_fixes(const DriveLogs::Log& log, TimeScale scale, const Projection& projection) {
  if (log.rough.empty()) return {};
  std::vector<RoughPosition> positions = log.rough;
  put_on_scale(positions, log, scale, [](RoughPosition& position) -> Stamp& { return position.stamp; });
  std::stable_sort(positions.begin(), positions.end(),
                   [](const RoughPosition& a, const RoughPosition& b) { return a.stamp < b.stamp; });
  const Eigen::Vector3d middle = middle_of(positions);
  std::vector<Fix> fixes;
  for (const RoughPosition& position : positions) {
    if ((position.ecef - middle).norm() > kFarthest_m) continue;
    if (!fixes.empty() && fixes.back().stamp == position.stamp) continue;
    fixes.push_back(rough_fix(position, projection));
  }
  return fixes;
}

}  // namespace waymark::drive
