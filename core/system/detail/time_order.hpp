/// The order in which the graph of a window is eliminated.
#pragma once

#include <vector>

#include <waymark/core/graph/graph.hpp>

namespace waymark::detail {

/// Orders the vertices that are not fixed and have edges. A vertex with a place and a stamp comes at that
/// time. All others come when their last neighbour does: a bias after the last pose that it joins, for
/// eliminated before, it would join all of these. A state of no time (a scale of the whole drive) comes
/// last. In a graph without stamps this is the order of the vertices, states without a place last.
[[nodiscard]] std::vector<VertexIndex> time_order(const Graph& graph);

}  // namespace waymark::detail
