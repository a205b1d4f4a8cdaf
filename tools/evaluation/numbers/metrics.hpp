/// Error metrics over the PPS poses: pure functions from offsets to numbers.
///
/// An offset is d_i = estimate_i - truth_i, a 2-vector in metres on the axes of the metric frame.
/// An undefined number (no sample, or a deviation from one sample) is NaN, never an exception.
/// tools/evaluation/README.md has definitions and formulae.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>

#include <Eigen/Core>

namespace waymark::evaluation {

inline constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

/// Position metrics of one system, metres. The first three are those of the paper's Sec. III-B. The
/// paper prints D_i without the truth, but it means the distance of an offset from the mean offset.
struct PositionMetrics {
  std::size_t count = 0;
  double max_m = kUndefined;       ///< max |d_i|
  double accuracy_m = kUndefined;  ///< |mean d|: the structural offset
  /// sqrt(sum |d_i - mean d|^2 / (n - 1)); undefined for fewer than two offsets
  double precision_m = kUndefined;
  double rmse_m = kUndefined;    ///< sqrt(sum |d_i|^2 / n)
  double median_m = kUndefined;  ///< of |d_i|; the mean of the two middle ones if n is even
  /// smallest radius about the truth that contains at least 50 % of the epochs
  double cep50_m = kUndefined;
  double cep95_m = kUndefined;  ///< the same for 95 %
  /// mean d: x east, y north on the grid
  Eigen::Vector2d mean_m = Eigen::Vector2d::Constant(kUndefined);

  /// Tells whether the positions are the truth, to a millimetre. No receiver and no reference agree so well: the
  /// same log is read as both.
  [[nodiscard]] bool are_truth() const { return count > 0 && rmse_m < 1e-3; }
};

/// Statistics of a signed quantity, in the unit of the quantity.
struct ScalarStatistics {
  std::size_t count = 0;
  double mean = kUndefined;
  /// about the mean, divisor n - 1; undefined for fewer than two values
  double deviation = kUndefined;
  double rms = kUndefined;  ///< about zero, divisor n
  double max_abs = kUndefined;
};

/// Offsets along the direction of travel (positive: ahead of the truth) and across it (positive: to
/// the left), metres. Epochs without a known direction are left out.
struct TrackMetrics {
  ScalarStatistics along;
  ScalarStatistics cross;
};

/// The reduction of the fused numbers against the raw ones: 100 (1 - fused / raw), percent.
/// Negative is worse.
struct Improvement {
  double max_percent = kUndefined;
  double accuracy_percent = kUndefined;
  double precision_percent = kUndefined;
  double rmse_percent = kUndefined;
  double median_percent = kUndefined;
  double cep50_percent = kUndefined;
  double cep95_percent = kUndefined;
};

/// An offset along a direction (positive: ahead) and across it (positive: to the left), metres.
struct TrackOffset {
  double along_m = 0;
  double cross_m = 0;
};

/// @param direction_rad counter-clockwise from grid east
[[nodiscard]] TrackOffset track_offset(const Eigen::Vector2d& offset, double direction_rad);

[[nodiscard]] PositionMetrics position_metrics(std::span<const Eigen::Vector2d> offsets);

[[nodiscard]] ScalarStatistics scalar_statistics(std::span<const double> values);

/// @param directions_rad direction of travel at each offset, counter-clockwise from grid
/// east; same length
/// @throws UsageError if the lengths differ
[[nodiscard]] TrackMetrics track_metrics(std::span<const Eigen::Vector2d> offsets,
                                         std::span<const std::optional<double>> directions_rad);

/// Returns 100 (1 - fused / raw). NaN if raw is zero or either is undefined.
[[nodiscard]] double improvement_percent(double raw, double fused);

[[nodiscard]] Improvement improvement(const PositionMetrics& raw, const PositionMetrics& fused);

/// Returns the middle value, or the mean of the two middle ones. @param sorted ascending @return
/// NaN for no values
[[nodiscard]] double sorted_median(std::span<const double> sorted);

/// Returns the nearest-rank quantile: the smallest value that is >= at least a share `probability`
/// of the values.
/// @param sorted ascending
/// @param probability in (0, 1]
/// @return NaN for no values
[[nodiscard]] double nearest_rank_quantile(std::span<const double> sorted, double probability);

}  // namespace waymark::evaluation
