/// The starts (initial guesses) of the plane as registry entries. types_se2/start/README.md
/// describes the methods. They use the values of fixed vertices and of the first vertex of each
/// part, and no other values of the graph.
#pragma once

#include <waymark/core/optimize/start.hpp>

namespace waymark {

/// Chains poses along consecutive vertices. A vertex that the chain does not reach is placed from
/// it along the fewest edges.
[[nodiscard]] StartType odometry_start();
/// Chains poses along the tree of least heading variance from the first vertex of each part.
[[nodiscard]] StartType spanning_tree_start();
/// Solves two linear systems: headings as relaxed complex numbers, then positions. Absolute
/// positions (GNSS) are part of the first system, so that they anchor the headings.
[[nodiscard]] StartType linear_start();

}  // namespace waymark
