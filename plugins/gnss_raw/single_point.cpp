#include <waymark/plugins/gnss_raw/detail/single_point.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

namespace waymark::plugins::gnss_raw {
namespace {

constexpr std::size_t kFewestPseudoranges = 5;
constexpr int kIterationsAtAScale = 6;
constexpr double kInnerEarth_m = 6.34e6;
constexpr double kOuterEarth_m = 6.40e6;

struct Range {
  Eigen::Vector3d satellite;
  double measured_m;
};

std::vector<double> residuals(const std::vector<Range>& ranges, const Eigen::Vector4d& at) {
  std::vector<double> all;
  for (const Range& range : ranges)
    all.push_back(range.measured_m - (range.satellite - at.head<3>()).norm() - at[3]);
  return all;
}

/// One step of weighted least squares. @returns whether it has a solution
bool step(const std::vector<Range>& ranges, double scale_m, Eigen::Vector4d& at) {
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  const std::vector<double> errors = residuals(ranges, at);
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const double weight = 1 / (1 + errors[i] * errors[i] / (scale_m * scale_m));
    Eigen::Vector4d row;
    row << (at.head<3>() - ranges[i].satellite).normalized(), 1;
    normal += weight * row * row.transpose();
    right += weight * errors[i] * row;
  }
  const Eigen::LDLT<Eigen::Matrix4d> solver(normal);
  if (solver.info() != Eigen::Success || !(solver.rcond() > 1e-8)) return false;
  at += solver.solve(right);
  return at.allFinite();
}

}  // namespace

std::optional<SinglePoint> single_point(const Epoch& epoch, const Eigen::Vector3d& guess, bool turned) {
  std::vector<Range> ranges;
  for (const SatelliteReading& reading : epoch.satellites) {
    if (std::isnan(reading.pseudorange_m)) continue;
    // A clock that is 1 ms off turns the satellite by 2 m too much or too little: enough for a start.
    const double travel_s = turned ? 0 : reading.pseudorange_m / kLight_mps;
    ranges.push_back({turned_with_earth(reading.position, travel_s), reading.pseudorange_m});
  }
  if (ranges.size() < kFewestPseudoranges) return std::nullopt;
  Eigen::Vector4d at;
  at << guess, 0;
  constexpr std::array<double, 5> kScales_m{std::numeric_limits<double>::infinity(), 100, 40, 16, 8};
  for (const double scale_m : kScales_m)
    for (int i = 0; i < kIterationsAtAScale; ++i)
      if (!step(ranges, scale_m, at)) return std::nullopt;
  const double radius = at.head<3>().norm();
  if (!(radius > kInnerEarth_m && radius < kOuterEarth_m)) return std::nullopt;
  std::vector<double> sizes = residuals(ranges, at);
  for (double& size : sizes) size = std::abs(size);
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return SinglePoint{at.head<3>(), at[3], *middle};
}

}  // namespace waymark::plugins::gnss_raw
