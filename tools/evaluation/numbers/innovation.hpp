/// Normalised innovation statistics: does the stated accuracy of the fixes fit what is seen? Needs no truth.
#pragma once

#include <cstddef>
#include <span>

#include <Eigen/Core>

#include <waymark/tools/evaluation/numbers/metrics.hpp>

namespace waymark::evaluation {

/// What a residual "fix - predicted antenna position" is, by the part the fix played in the graph.
enum class ResidualKind {
  post_fit,   ///< accepted fixes: the pose was fitted to them, so nu is too small on average
  gated,      ///< rejected fixes: chosen for being far off, so nu is too large on average
  prediction  ///< withheld fixes: true innovations, the only ones whose nu is chi2 distributed
};

/// "post-fit residuals", "residuals of rejected fixes", "innovations".
[[nodiscard]] const char* to_string(ResidualKind kind);

/// Statistics of nu = r^T S^-1 r over the fixes of one kind.
struct InnovationStatistics {
  static constexpr double kExpectedMean = 2;             ///< of chi2 with two degrees of freedom
  static constexpr double kBound95 = 5.991464547107979;  ///< -2 ln 0.05: its 95 % quantile
  static constexpr double kExpectedInside = 0.95;        ///< of fraction_inside

  ResidualKind kind = ResidualKind::post_fit;
  std::size_t count = 0;      ///< fixes with a defined nu
  std::size_t undefined = 0;  ///< fixes left out: S not positive definite, or a number not finite
  double mean = kUndefined;
  /// Deviation of `mean` to be expected of `count` independent innovations: 2 / sqrt(count). GNSS errors are
  /// correlated over minutes, so the true one is larger.
  double expected_deviation = kUndefined;
  double fraction_inside = kUndefined;  ///< share of fixes with nu <= kBound95
  double max = kUndefined;
};

/// Covariance S of a residual: fix covariance R plus that of the pose P where the fix took no part in the
/// graph, R - P where it did (the residual of an optimal estimate is smaller than the measurement's own
/// noise), R where no P is given.
/// @param fix_covariance   2x2, m^2, frame axes.
/// @param pose_covariance  2x2 of the pose's position, m^2, frame axes, or nullptr. The part of the heading's
///                         uncertainty that reaches the antenna through its lever arm is left out.
[[nodiscard]] Eigen::Matrix2d residual_covariance(ResidualKind kind, const Eigen::Matrix2d& fix_covariance,
                                                  const Eigen::Matrix2d* pose_covariance);

/// nu = r^T S^-1 r; NaN where S is not positive definite or anything is not finite.
[[nodiscard]] double normalised_innovation_squared(const Eigen::Vector2d& residual_m,
                                                   const Eigen::Matrix2d& covariance);

/// @param nu  one value per fix of this kind; NaNs are counted as undefined and left out.
[[nodiscard]] InnovationStatistics innovation_statistics(ResidualKind kind, std::span<const double> nu);

}  // namespace waymark::evaluation
