#include <waymark/core/drive/place_from_ranges.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>

#include <waymark/core/base/detail/median.hpp>

namespace waymark {
namespace {

constexpr std::size_t kFewestRanges = 5;
constexpr int kIterationsAtAScale = 6;
constexpr double kInnerEarth_m = 6.34e6;
constexpr double kOuterEarth_m = 6.40e6;

std::vector<double> residuals(std::span<const MeasuredRange> ranges, const Eigen::Vector4d& at) {
  std::vector<double> all;
  for (const MeasuredRange& range : ranges)
    all.push_back(range.measured_m - (range.point - at.head<3>()).norm() - at[3]);
  return all;
}

/// One step of weighted least squares. @returns whether it has a solution
bool step(std::span<const MeasuredRange> ranges, double scale_m, Eigen::Vector4d& at) {
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  const std::vector<double> errors = residuals(ranges, at);
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const double weight = 1 / (1 + errors[i] * errors[i] / (scale_m * scale_m));
    Eigen::Vector4d row;
    row << (at.head<3>() - ranges[i].point).normalized(), 1;
    normal += weight * row * row.transpose();
    right += weight * errors[i] * row;
  }
  const Eigen::LDLT<Eigen::Matrix4d> solver(normal);
  if (solver.info() != Eigen::Success || !(solver.rcond() > 1e-8)) return false;
  at += solver.solve(right);
  return at.allFinite();
}

}  // namespace

std::optional<PlaceFromRanges> place_from_ranges(std::span<const MeasuredRange> ranges,
                                                 const Eigen::Vector3d& guess) {
  if (ranges.size() < kFewestRanges) return std::nullopt;
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
  return PlaceFromRanges{at.head<3>(), at[3], upper_median(std::move(sizes))};
}

}  // namespace waymark
