/// The gauge of a graph: the rigid motions of its parts that the edges cannot observe.
///
/// The result is a value. It is valid for the values and edges that the graph had.
#pragma once

#include <string>
#include <vector>

#include <waymark/core/base/export.hpp>
#include <waymark/core/graph/graph.hpp>

namespace WAYMARK_EXPORT waymark {

/// The vertices that are held so that the problem is determined, and the messages for the user.
struct Gauge {
  /// per vertex: it keeps its value (fixed vertices of the graph are not counted)
  std::vector<char> held;
  std::vector<std::string> messages;  ///< one sentence per component that was held
};

/// What to do with a component that is anchored in part.
enum class PartlyAnchored {
  refuse,  ///< throw
  hold     ///< hold its first vertex, with a message: more measurements will come
};

/// Examines every component of free vertices joined by edges. Its rigid-motion information is M =
/// sum (J T)^T Omega (J T), where T are the motions along x, along y and about the centre (scaled
/// by the extent). T moves a component in 3 ways; a single point in 2, because it turns about itself. The rank of M
/// decides:
/// - 0: nothing anchors the component. Its first vertex that has a heading is held, as usual in the field, and a
///   message says so.
/// - all: the component is anchored, and nothing is held.
/// - 1, or 2 of 3: it is anchored in part (one fix; a parked car), if that is also the rank of the directions in which
///   the edges are moved. What is known to 1e4 m only is faint in M beside 1e-6 rad, but known.
/// @throws InputError for a component that is anchored in part, or that turns about any vertex that is held (points
/// with distances between them); it names a vertex and the missing measurement. With `hold` both are held
[[nodiscard]] Gauge find_gauge(const Graph& graph, PartlyAnchored partly = PartlyAnchored::refuse);

}  // namespace waymark
