/// The gauge of a graph: which rigid motions of its parts the edges cannot see.
#pragma once

#include <string>
#include <vector>

#include <waymark/core/graph/graph.hpp>

namespace waymark {

/// What is held to make the problem determined, and what must be told to the user.
struct Gauge {
  std::vector<char> held;  ///< per vertex: kept at its value (fixed vertices of the graph are not counted)
  std::vector<std::string> messages;  ///< one sentence per component that was held
};

/// Looks at every component of free vertices joined by edges. Its rigid-motion information M = sum (J T)^T
/// Omega (J T), T the motions along x, along y and about the centre (scaled by the extent), has rank
///   0: nothing anchors the component; its first vertex is held, as the field does, and the message says so;
///   3: it is anchored; nothing is held;
///   1, 2: it is anchored in part (one fix; a parked car).
/// @throws InputError for rank 1 or 2: names a vertex and what would fix it.
[[nodiscard]] Gauge find_gauge(const Graph& graph);

}  // namespace waymark
