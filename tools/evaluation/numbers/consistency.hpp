/// Stated against actual error: tests whether the covariances of an estimate fit its errors
/// against truth.
#pragma once

#include <cstddef>
#include <span>

#include <Eigen/Core>

#include <waymark/core/drive/stamp.hpp>
#include <waymark/tools/evaluation/numbers/metrics.hpp>

namespace waymark::evaluation {

/// The interval in which a statistic of a consistent estimate lies in 95 of 100 drives.
struct Interval95 {
  double low = kUndefined;
  double high = kUndefined;
};

/// NEES = d^T P^-1 d of an error d with stated covariance P. It is chi2 with two degrees of freedom
/// if P is consistent. tools/evaluation/README.md, "Stated against actual error", has the formulae.
struct ConsistencyStatistics {
  static constexpr double kExpectedMean = 2;         ///< of nees_mean
  static constexpr double kExpectedCoverage = 0.95;  ///< of coverage

  std::size_t count = 0;  ///< epochs with a defined NEES
  /// epochs left out: P is not positive definite, or a number is not finite
  std::size_t undefined = 0;
  /// Independent samples among `count`: effective_sample_size of the errors in sigmas (P^-1/2 d).
  double effective_samples = kUndefined;
  double nees_mean = kUndefined;
  Interval95 nees_mean_consistent;  ///< range of nees_mean for a consistent covariance
  /// share of epochs whose 95 % region contains the truth: NEES <= -2 ln 0.05
  double coverage = kUndefined;
  Interval95 coverage_consistent;
  /// Median of sqrt(NEES / 2 ln 2), the actual error in units of the stated one. It is 1 if P is
  /// consistent, and 2 if the stated sigmas are half of the true ones.
  double median_error_ratio = kUndefined;
};

/// @param offsets errors, m; one per stamp
/// @param covariances stated ones, m^2, on the axes of the offsets; one per stamp
/// @throws UsageError if the lengths differ
[[nodiscard]] ConsistencyStatistics consistency_statistics(std::span<const Stamp> stamps,
                                                           std::span<const Eigen::Vector2d> offsets,
                                                           std::span<const Eigen::Matrix2d> covariances);

/// Returns the range of the mean NEES of a consistent estimate. N_eff times the mean is chi2 with 2
/// N_eff degrees of freedom (rounded to a whole number), so the range is its quantiles over N_eff.
/// @param effective_samples >= 1
[[nodiscard]] Interval95 consistent_nees_mean(double effective_samples);

/// Returns the range of the coverage of a consistent estimate: the 2.5 % and 97.5 % quantiles of
/// the binomial distribution with N_eff (rounded) trials and probability 0.95, over N_eff. @param
/// effective_samples >= 1
[[nodiscard]] Interval95 consistent_coverage(double effective_samples);

}  // namespace waymark::evaluation
