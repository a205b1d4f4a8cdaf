/// How long errors last: their autocorrelation, and how many independent samples a series is worth.
///
/// Errors are 2-vectors in metres or in sigmas, both axes pooled, sampled at stamps of any order and spacing.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/stamp.hpp>

namespace waymark::evaluation {

/// Lags at which evaluations state it, s.
inline constexpr std::array<double, 3> kAutocorrelationLags = {1, 10, 60};

/// Autocorrelation of an error series about its mean: the mean product of the pairs whose stamps are `lag`
/// apart, to within half a median interval of the series, over the mean square. 1: the same error still; 0:
/// forgotten. The mean is the series' own, so errors that last longer than the series count as its mean.
/// NaN where no pair is that far apart or nothing varies. O(n) per lag.
/// @param offsets  one per stamp, finite
/// @param lags_s   > 0
/// @throws UsageError where the lengths differ.
[[nodiscard]] std::vector<double> error_autocorrelation(std::span<const Stamp> stamps,
                                                        std::span<const Eigen::Vector2d> offsets,
                                                        std::span<const double> lags_s);

/// How many independent samples the mean over a series of zero-mean errors is worth, in [1, n]:
///
///   N_eff = n / (1 + 2 sum_k rho_k),  rho_k = sum over the pairs k intervals apart of e_i . e_j / sum
///   |e_i|^2
///
/// over lags of k median intervals, of which neighbours are added in pairs until a pair's sum is not positive
/// (the initial positive sequence: Geyer, Practical Markov Chain Monte Carlo, Statistical Science 7, 1992,
/// Sec. 3.3), and at most duration / tau, tau being where the correlation has fallen to 1/e. About zero, not
/// about the mean: a bias that lasts the whole drive is one sample of it, however long the drive. 0 for no
/// errors. Lags from 32 intervals on are taken together in wider and wider groups: O(n log n).
/// @throws UsageError where the lengths differ.
[[nodiscard]] double effective_sample_size(std::span<const Stamp> stamps,
                                           std::span<const Eigen::Vector2d> errors);

}  // namespace waymark::evaluation
