/// The starts of the plane, as registry entries (types_se2/start/README.md has the methods).
/// None of them looks at the graph's values beyond fixed vertices and the first vertex of each part.
#pragma once

#include <waymark/core/optimize/start.hpp>

namespace waymark {

/// Poses chained along consecutive vertices; what the chain does not reach, by the fewest edges from it.
[[nodiscard]] StartType odometry_start();
/// Poses chained along the tree of best-known headings from the first vertex of each part.
[[nodiscard]] StartType spanning_tree_start();
/// Two linear systems: headings as relaxed complex numbers, then positions. Absolute positions (GNSS) take
/// part in the first, so that they anchor the headings.
[[nodiscard]] StartType linear_start();

}  // namespace waymark
