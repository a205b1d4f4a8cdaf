/// Finds the vertices that have edges.
#pragma once

#include <vector>

#include <waymark/core/graph/graph.hpp>

namespace waymark {

/// Returns a number per vertex: not zero if at least one edge joins it. A vertex without edges is
/// no unknown, and its gauge is not judged.
[[nodiscard]] std::vector<char> vertices_with_edges(const Graph& graph);

}  // namespace waymark
