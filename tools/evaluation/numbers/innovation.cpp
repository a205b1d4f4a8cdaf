#include <waymark/tools/evaluation/numbers/innovation.hpp>

#include <algorithm>
#include <cmath>

namespace waymark::evaluation {

const char* to_string(ResidualKind kind) {
  switch (kind) {
    case ResidualKind::post_fit:
      return "post-fit residuals";
    case ResidualKind::gated:
      return "residuals of rejected fixes";
    case ResidualKind::prediction:
      return "innovations";
  }
  return "";
}

Eigen::Matrix2d residual_covariance(ResidualKind kind, const Eigen::Matrix2d& fix_covariance,
                                    const Eigen::Matrix2d* pose_covariance) {
  if (pose_covariance == nullptr) return fix_covariance;
  if (kind == ResidualKind::post_fit) return fix_covariance - *pose_covariance;
  return fix_covariance + *pose_covariance;
}

double normalised_innovation_squared(const Eigen::Vector2d& residual_m, const Eigen::Matrix2d& covariance) {
  // Cholesky by hand. The two pivots show whether S is positive definite.
  const double a = covariance(0, 0);
  const double b = 0.5 * (covariance(0, 1) + covariance(1, 0));
  const double pivot = covariance(1, 1) - b * b / a;
  if (!(a > 0) || !(pivot > 0)) return kUndefined;
  const double second = residual_m.y() - b / a * residual_m.x();
  const double nu = residual_m.x() * residual_m.x() / a + second * second / pivot;
  return std::isfinite(nu) ? nu : kUndefined;
}

InnovationStatistics innovation_statistics(ResidualKind kind, std::span<const double> nu) {
  InnovationStatistics statistics;
  statistics.kind = kind;
  double sum = 0;
  double largest = 0;
  std::size_t inside = 0;
  for (const double value : nu) {
    if (std::isnan(value)) {
      ++statistics.undefined;
      continue;
    }
    ++statistics.count;
    sum += value;
    largest = std::max(largest, value);
    if (value <= InnovationStatistics::kBound95) ++inside;
  }
  if (statistics.count == 0) return statistics;
  const auto n = static_cast<double>(statistics.count);
  statistics.mean = sum / n;
  statistics.expected_deviation = 2 / std::sqrt(n);
  statistics.fraction_inside = static_cast<double>(inside) / n;
  statistics.max = largest;
  return statistics;
}

}  // namespace waymark::evaluation
