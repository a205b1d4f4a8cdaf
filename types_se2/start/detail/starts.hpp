/// The starts (initial guesses) of the plane as registry entries. types_se2/start/README.md
/// describes the methods. They use the values of fixed vertices and of the first vertex of each
/// part, and no other values of the graph.
#pragma once

#include <string>

#include <waymark/core/optimize/start.hpp>

namespace waymark {

/// Returns why a graph with poses of another space has no start of the plane.
[[nodiscard]] inline std::string foreign_note(const Graph& graph, VertexIndex foreign) {
  return "it is for poses of the plane, and the graph has " + graph.vertex_type(foreign).tag +
         "; begin at the values of the file, or with a start of the plugin that brings the type";
}

/// Chains poses along consecutive vertices. A vertex that the chain does not reach is placed from
/// it along the fewest edges.
[[nodiscard]] StartType odometry_start();
/// Chains poses along the tree of least heading variance from the first vertex of each part.
[[nodiscard]] StartType spanning_tree_start();
/// Solves two linear systems: headings as relaxed complex numbers, then positions. Absolute
/// positions (GNSS) are part of the first system, so that they anchor the headings.
[[nodiscard]] StartType linear_start();

}  // namespace waymark
