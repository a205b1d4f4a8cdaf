/// What the field does about outliers beside gates and losses, for comparison.
#pragma once

#include <span>
#include <vector>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/evaluation/evaluation.hpp>
#include <waymark/tools/reproduction/experiment/minimization.hpp>

namespace waymark::reproduction {

struct Graduated {
  Ending ending;
  std::size_t outliers = 0;  ///< edges of fixes; the graph lacks them
};

/// Graduated non-convexity as `waymark optimize --robust gnc` has it, but that nothing is doubted beside the
/// fixes (edges whose error is a "position").
[[nodiscard]] Graduated graduate_fixes(Graph& graph, const Setting& setting, const TypeRegistry& registry,
                                       const std::atomic<bool>* cancel);

/// Fixes whose residuals, averaged over this time to either side, judge a fix.
inline constexpr double kInflationWindow = 15;  // s

/// Adaptive inflation: the covariance of each fix times the mean of nu / 2 (the normalised residual squared,
/// 1 on the average where covariances are honest) of the accepted fixes of its receiver within the window,
/// where that is above 1.
/// @param fixes      by time @param residuals of a first pass, one per fix
[[nodiscard]] std::vector<Fix> inflate_fixes(std::span<const Fix> fixes,
                                             std::span<const evaluation::EpochResult> residuals);

}  // namespace waymark::reproduction
