#include <waymark/tools/evaluation/numbers/metrics.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <waymark/core/base/error.hpp>

namespace waymark::evaluation {

double sorted_median(std::span<const double> sorted) {
  const std::size_t n = sorted.size();
  if (n == 0) return kUndefined;
  const std::size_t middle = n / 2;
  return n % 2 == 1 ? sorted[middle] : 0.5 * (sorted[middle - 1] + sorted[middle]);
}

double nearest_rank_quantile(std::span<const double> sorted, double probability) {
  if (sorted.empty()) return kUndefined;
  const auto n = static_cast<double>(sorted.size());
  // 0.07 * 100 is 7.000000000000001. Rounding alone must not raise a rank.
  const double rank = std::clamp(std::ceil(probability * n - 1e-9), 1.0, n);
  return sorted[static_cast<std::size_t>(rank) - 1];
}

PositionMetrics position_metrics(std::span<const Eigen::Vector2d> offsets) {
  PositionMetrics metrics;
  metrics.count = offsets.size();
  if (offsets.empty()) return metrics;
  const auto n = static_cast<double>(offsets.size());

  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double squares = 0;
  std::vector<double> radii;
  radii.reserve(offsets.size());
  for (const Eigen::Vector2d& d : offsets) {
    sum += d;
    squares += d.squaredNorm();
    radii.push_back(d.norm());
  }
  std::sort(radii.begin(), radii.end());

  metrics.mean_m = sum / n;
  metrics.accuracy_m = metrics.mean_m.norm();
  metrics.rmse_m = std::sqrt(squares / n);
  metrics.max_m = radii.back();
  metrics.median_m = sorted_median(radii);
  metrics.cep50_m = nearest_rank_quantile(radii, 0.50);
  metrics.cep95_m = nearest_rank_quantile(radii, 0.95);
  if (offsets.size() > 1) {
    // a second pass: sum of squares minus squared mean would cancel if the bias is large
    double scatter = 0;
    for (const Eigen::Vector2d& d : offsets) scatter += (d - metrics.mean_m).squaredNorm();
    metrics.precision_m = std::sqrt(scatter / (n - 1));
  }
  return metrics;
}

ScalarStatistics scalar_statistics(std::span<const double> values) {
  ScalarStatistics statistics;
  statistics.count = values.size();
  if (values.empty()) return statistics;
  const auto n = static_cast<double>(values.size());

  double sum = 0;
  double squares = 0;
  double largest = 0;
  for (const double value : values) {
    sum += value;
    squares += value * value;
    largest = std::max(largest, std::abs(value));
  }
  statistics.mean = sum / n;
  statistics.rms = std::sqrt(squares / n);
  statistics.max_abs = largest;
  if (values.size() > 1) {
    double scatter = 0;
    for (const double value : values) scatter += (value - statistics.mean) * (value - statistics.mean);
    statistics.deviation = std::sqrt(scatter / (n - 1));
  }
  return statistics;
}

TrackOffset track_offset(const Eigen::Vector2d& offset, double direction_rad) {
  const Eigen::Vector2d ahead(std::cos(direction_rad), std::sin(direction_rad));
  return {.along_m = ahead.dot(offset), .cross_m = ahead.x() * offset.y() - ahead.y() * offset.x()};
}

TrackMetrics track_metrics(std::span<const Eigen::Vector2d> offsets,
                           std::span<const std::optional<double>> directions_rad) {
  if (offsets.size() != directions_rad.size())
    throw UsageError("track_metrics: " + std::to_string(offsets.size()) + " offsets but " +
                     std::to_string(directions_rad.size()) + " directions");
  std::vector<double> along;
  std::vector<double> cross;
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    if (!directions_rad[i]) continue;
    const TrackOffset offset = track_offset(offsets[i], *directions_rad[i]);
    along.push_back(offset.along_m);
    cross.push_back(offset.cross_m);
  }
  return TrackMetrics{.along = scalar_statistics(along), .cross = scalar_statistics(cross)};
}

double improvement_percent(double raw, double fused) {
  if (!(std::abs(raw) > 0)) return kUndefined;
  return 100 * (1 - fused / raw);
}

Improvement improvement(const PositionMetrics& raw, const PositionMetrics& fused) {
  return Improvement{.max_percent = improvement_percent(raw.max_m, fused.max_m),
                     .accuracy_percent = improvement_percent(raw.accuracy_m, fused.accuracy_m),
                     .precision_percent = improvement_percent(raw.precision_m, fused.precision_m),
                     .rmse_percent = improvement_percent(raw.rmse_m, fused.rmse_m),
                     .median_percent = improvement_percent(raw.median_m, fused.median_m),
                     .cep50_percent = improvement_percent(raw.cep50_m, fused.cep50_m),
                     .cep95_percent = improvement_percent(raw.cep95_m, fused.cep95_m)};
}

}  // namespace waymark::evaluation
