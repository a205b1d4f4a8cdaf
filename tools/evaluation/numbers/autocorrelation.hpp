/// The duration of errors: their autocorrelation, and the number of independent samples
/// in a series.
///
/// Errors are 2-vectors in metres or in sigmas. Both axes are pooled. Stamps may have any order
/// and spacing.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/stamp.hpp>

namespace waymark::evaluation {

/// The lags in evaluations, s.
inline constexpr std::array<double, 3> kAutocorrelationLags = {1, 10, 60};

/// Returns the autocorrelation of a series of errors about its mean. It is the mean product of
/// pairs whose stamps are `lag` apart (within half a median interval), over the mean square. 1
/// means the same error, 0 means forgotten. The mean is that of the series, so an error that lasts
/// longer than the series counts as its mean. NaN if no pair is that far apart or nothing varies.
/// O(n) per lag.
/// @param offsets one per stamp, finite
/// @param lags_s > 0
/// @throws UsageError if the lengths differ
[[nodiscard]] std::vector<double> error_autocorrelation(std::span<const Stamp> stamps,
                                                        std::span<const Eigen::Vector2d> offsets,
                                                        std::span<const double> lags_s);

/// Returns the number of independent samples in the mean of a series of zero-mean
/// errors, in [1, n]:
///
///   N_eff = n / (1 + 2 sum_k rho_k),
///   rho_k = sum over the pairs k intervals apart of e_i . e_j / sum |e_i|^2
///
/// The lags are k median intervals. Consecutive lags are added in pairs until the sum of a pair is
/// not positive (the initial positive sequence: Geyer, Practical Markov Chain Monte Carlo,
/// Statistical Science 7, 1992, Sec. 3.3). The result is at most duration / tau, where tau is the
/// lag at which the correlation has fallen to 1/e. Errors are taken about zero, not about the mean,
/// so a bias that lasts the whole drive is one sample, however long the drive. 0 for no errors.
/// From 32 intervals on, lags are combined in wider and wider groups: O(n log n).
/// @throws UsageError if the lengths differ
[[nodiscard]] double effective_sample_size(std::span<const Stamp> stamps,
                                           std::span<const Eigen::Vector2d> errors);

}  // namespace waymark::evaluation
