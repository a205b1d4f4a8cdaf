/// The name of an edge in messages.
#pragma once

#include <string>

#include <waymark/core/graph/graph.hpp>

namespace waymark::detail {

/// Returns "EDGE_X number 3 (vertices 4 and 5)".
[[nodiscard]] std::string edge_name(const Graph& graph, std::size_t batch, std::size_t edge);

}  // namespace waymark::detail
