/// Stated against actual error: do the covariances of an estimate fit its errors against truth?
#pragma once

#include <cstddef>
#include <span>

#include <Eigen/Core>

#include <waymark/core/drive/stamp.hpp>
#include <waymark/tools/evaluation/numbers/metrics.hpp>

namespace waymark::evaluation {

/// Where a statistic of an honest estimate lies in 95 of 100 drives.
struct Interval95 {
  double low = kUndefined;
  double high = kUndefined;
};

/// NEES = d^T P^-1 d of an error d with stated covariance P: chi2 with two degrees of freedom where P is
/// honest. Formulae: tools/evaluation/README.md, "Stated against actual error".
struct ConsistencyStatistics {
  static constexpr double kExpectedMean = 2;         ///< of nees_mean
  static constexpr double kExpectedCoverage = 0.95;  ///< of coverage

  std::size_t count = 0;      ///< epochs with a defined NEES
  std::size_t undefined = 0;  ///< epochs left out: P not positive definite, or a number not finite
  /// Independent samples among `count`: effective_sample_size of the errors in sigmas (P^-1/2 d).
  double effective_samples = kUndefined;
  double nees_mean = kUndefined;
  Interval95 nees_mean_honest;   ///< where an honest covariance leaves nees_mean
  double coverage = kUndefined;  ///< share of epochs whose 95 % region holds the truth: NEES <= -2 ln 0.05
  Interval95 coverage_honest;
  /// Median of sqrt(NEES / 2 ln 2), the actual error in units of the stated one: 1 where P is honest, 2 where
  /// the stated sigmas are half of what they should be.
  double median_error_ratio = kUndefined;
};

/// @param offsets      errors, m; one per stamp
/// @param covariances  stated ones, m^2, on the axes of the offsets; one per stamp
/// @throws UsageError where the lengths differ.
[[nodiscard]] ConsistencyStatistics consistency_statistics(std::span<const Stamp> stamps,
                                                           std::span<const Eigen::Vector2d> offsets,
                                                           std::span<const Eigen::Matrix2d> covariances);

/// Where the mean NEES of an honest estimate lies: 2 N_eff of it are chi2 with 2 N_eff degrees of freedom
/// (rounded to a whole number), so quantiles of that over N_eff. @param effective_samples >= 1
[[nodiscard]] Interval95 honest_nees_mean(double effective_samples);

/// Where the coverage of an honest estimate lies: 2.5 % and 97.5 % quantiles of the binomial distribution of
/// N_eff (rounded) trials with probability 0.95, over N_eff. @param effective_samples >= 1
[[nodiscard]] Interval95 honest_coverage(double effective_samples);

}  // namespace waymark::evaluation
