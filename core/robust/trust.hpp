/// Trust in edges: which of them are known to be right, so that the search for outliers begins from them.
///
/// Nothing is kept after a call. Places belong to the graph of the same call.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include <waymark/core/base/export.hpp>
#include <waymark/core/optimize/optimizer.hpp>

namespace WAYMARK_EXPORT waymark {

/// Returns the trusted edges, ascending: those taken for right as long as the other edges do not contradict them.
/// odometry_edges() is such a rule.
using TrustRule = std::function<std::vector<EdgePlace>(const Graph&)>;

/// Returns a rule that looks at each edge alone.
[[nodiscard]] TrustRule trust_each(std::function<bool(const Graph&, EdgePlace)> is_trusted);

/// Returns groups of trusted edges that contradict each other between the same two places: odometry and a loop
/// closure between neighbours. chi2 of a group alone, at its minimum over one of the two, is beyond the
/// quantile. Which of its edges is wrong only the rest of the graph can tell.
/// @param trusted ascending, and so is every group @param probability of the chi-square quantile, in (0, 1)
[[nodiscard]] std::vector<std::vector<EdgePlace>> contradicting_parallels(const Graph& graph,
                                                                          std::span<const EdgePlace> trusted,
                                                                          Algorithm& algorithm,
                                                                          LinearSolver& solver,
                                                                          double probability);

}  // namespace waymark
