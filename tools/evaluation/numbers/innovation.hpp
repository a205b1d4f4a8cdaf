/// Normalised innovation statistics: test whether the stated accuracy of the fixes fits the
/// residuals. They need no truth.
#pragma once

#include <cstddef>
#include <span>

#include <Eigen/Core>

#include <waymark/tools/evaluation/numbers/metrics.hpp>

namespace waymark::evaluation {

/// The meaning of a residual "fix - predicted antenna position". It depends on the part of the fix
/// in the graph.
enum class ResidualKind {
  post_fit,  ///< accepted fixes: the poses were fitted to them, so nu is too small on average
  /// rejected fixes: they were rejected for large residuals, so nu is too large on average
  gated,
  prediction  ///< withheld fixes: true innovations; only their nu is chi2 distributed
};

/// Returns "post-fit residuals", "residuals of rejected fixes" or "innovations".
[[nodiscard]] const char* to_string(ResidualKind kind);

/// Statistics of nu = r^T S^-1 r over the fixes of one kind.
struct InnovationStatistics {
  /// mean of chi2 with two degrees of freedom: what innovations have, and no other kind
  static constexpr double kExpectedMean = 2;
  static constexpr double kBound95 = 5.991464547107979;  ///< -2 ln 0.05: its 95 % quantile
  static constexpr double kExpectedInside = 0.95;        ///< of fraction_inside

  ResidualKind kind = ResidualKind::post_fit;
  std::size_t count = 0;  ///< fixes with a defined nu
  /// fixes left out: S is not positive definite, or a number is not finite
  std::size_t undefined = 0;
  double mean = kUndefined;
  /// Expected deviation of `mean` for `count` independent innovations: 2 / sqrt(count). GNSS errors
  /// are correlated over minutes, so the true deviation is larger.
  double expected_deviation = kUndefined;
  double fraction_inside = kUndefined;  ///< share of fixes with nu <= kBound95
  double max = kUndefined;

  /// Tells whether kExpectedMean, kExpectedInside and expected_deviation hold for this kind.
  [[nodiscard]] bool has_expectation() const { return kind == ResidualKind::prediction; }
};

/// Returns the covariance S of a residual. Let R be the covariance of the fix and P that of the
/// pose. If the fix is not in the graph, S = R + P. If it is, S = R - P, because the residual of an
/// optimal estimate is smaller than the noise of the measurement. Without P, S = R.
/// @param fix_covariance 2x2, m^2, frame axes
/// @param pose_covariance 2x2 of the position of the pose, m^2, frame axes, or nullptr. The
/// heading's uncertainty also moves the antenna through its lever arm; this part is neglected.
[[nodiscard]] Eigen::Matrix2d residual_covariance(ResidualKind kind, const Eigen::Matrix2d& fix_covariance,
                                                  const Eigen::Matrix2d* pose_covariance);

/// Returns nu = r^T S^-1 r. NaN if S is not positive definite or anything is not finite.
[[nodiscard]] double normalised_innovation_squared(const Eigen::Vector2d& residual_m,
                                                   const Eigen::Matrix2d& covariance);

/// @param nu one value per fix of this kind; NaNs are counted as undefined and left out
[[nodiscard]] InnovationStatistics innovation_statistics(ResidualKind kind, std::span<const double> nu);

}  // namespace waymark::evaluation
