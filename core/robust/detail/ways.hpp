/// Ways: edges in a row that nothing else touches.
#pragma once

#include <span>
#include <vector>

#include <waymark/core/graph/graph.hpp>

namespace waymark::detail {

/// Returns the edges by their ways; every list is ascending. Two edges are on one way where they meet in a
/// free vertex without others, and each determines it from its other end. What is contradicted on a way falls to
/// zero without any of its edges, so that the minimum is the same, and none of them is more to blame than another.
/// @param edges ascending @param outside edges that do not count, ascending
[[nodiscard]] std::vector<std::vector<EdgePlace>> by_way(const Graph& graph, std::span<const EdgePlace> edges,
                                                         std::span<const EdgePlace> outside);

}  // namespace waymark::detail
