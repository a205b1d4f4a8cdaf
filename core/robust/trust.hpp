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

/// Tells whether an edge is trusted: taken for right as long as the other edges do not contradict it.
using TrustRule = std::function<bool(const Graph&, EdgePlace)>;

/// Recognises odometry. The edge joins two free vertices of one type that have a place in the
/// plane and consecutive ids, and its error determines one from the other (it has as many
/// dimensions as the tangent). Priors of run-time arity are trusted too, because marginalisation
/// made them from many edges.
[[nodiscard]] bool is_odometry_edge(const Graph& graph, EdgePlace place);

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
