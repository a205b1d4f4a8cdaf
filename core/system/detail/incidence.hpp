/// Which vertices have edges at all.
#pragma once

#include <vector>

#include <waymark/core/graph/graph.hpp>

namespace waymark {

/// Per vertex: not zero where at least one edge joins it. A vertex without edges is neither an unknown nor
/// judged for its gauge.
[[nodiscard]] std::vector<char> vertices_with_edges(const Graph& graph);

}  // namespace waymark
