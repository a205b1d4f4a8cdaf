#include <waymark/tools/evaluation/numbers/space_metrics.hpp>

#include <algorithm>
#include <cmath>

#include <waymark/core/base/error.hpp>

namespace waymark::evaluation {

SpaceMetrics space_metrics(std::span<const Eigen::Vector2d> offsets, std::span<const double> heights) {
  if (offsets.size() != heights.size()) throw UsageError("space_metrics: one height for each offset");
  SpaceMetrics metrics{.height = scalar_statistics(heights)};
  if (offsets.empty()) return metrics;
  const auto n = static_cast<double>(offsets.size());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double squares = 0;
  metrics.max_m = 0;
  const auto offset = [&](std::size_t i) {
    return Eigen::Vector3d(offsets[i].x(), offsets[i].y(), heights[i]);
  };
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    sum += offset(i);
    squares += offset(i).squaredNorm();
    metrics.max_m = std::max(metrics.max_m, offset(i).norm());
  }
  metrics.rmse_m = std::sqrt(squares / n);
  if (offsets.size() < 2) return metrics;
  double about_mean = 0;
  for (std::size_t i = 0; i < offsets.size(); ++i) about_mean += (offset(i) - sum / n).squaredNorm();
  metrics.precision_m = std::sqrt(about_mean / (n - 1));
  return metrics;
}

}  // namespace waymark::evaluation
