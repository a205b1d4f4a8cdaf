/// Treatments of outliers in the literature besides gates and losses, for comparison.
#pragma once

#include <span>
#include <vector>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/evaluation/evaluation.hpp>
#include <waymark/tools/reproduction/experiment/minimization.hpp>

namespace waymark::reproduction {

struct Graduated {
  Ending ending;
  std::size_t outliers = 0;  ///< edges of fixes; they were removed from the graph
};

/// Runs graduated non-convexity as `waymark optimize --robust gnc` does, but only fixes are
/// candidates (edges whose error is a "position").
[[nodiscard]] Graduated graduate_fixes(Graph& graph, const Setting& setting, const TypeRegistry& registry,
                                       const std::atomic<bool>* cancel);

/// The fixes within this time on either side judge a fix.
inline constexpr double kInflationWindow = 15;  // s

/// Adaptive inflation. The covariance of each fix is multiplied by the mean of nu / 2 over the
/// accepted fixes of its receiver within the window, if that is above 1. nu is the normalised
/// residual squared; nu / 2 is 1 on average if covariances are consistent.
/// @param fixes in order of time
/// @param residuals of a first pass, one per fix
[[nodiscard]] std::vector<Fix> inflate_fixes(std::span<const Fix> fixes,
                                             std::span<const evaluation::EpochResult> residuals);

}  // namespace waymark::reproduction
