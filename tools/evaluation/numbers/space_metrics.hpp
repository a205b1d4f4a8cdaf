/// Errors of a height state, and of the position in space.
#pragma once

#include <span>

#include <Eigen/Core>

#include <waymark/tools/evaluation/numbers/metrics.hpp>

namespace waymark::evaluation {

/// As PositionMetrics, of offsets in three dimensions.
struct SpaceMetrics {
  ScalarStatistics height;          ///< estimate - truth, m
  double max_m = kUndefined;        ///< max |d_i|
  double rmse_m = kUndefined;       ///< sqrt(sum |d_i|^2 / n)
  double precision_m = kUndefined;  ///< sqrt(sum |d_i - mean d|^2 / (n - 1))
};

/// @param offsets in the plane, m @param heights estimate - truth, m; same length
/// @throws UsageError if the lengths differ
[[nodiscard]] SpaceMetrics space_metrics(std::span<const Eigen::Vector2d> offsets,
                                         std::span<const double> heights);

}  // namespace waymark::evaluation
