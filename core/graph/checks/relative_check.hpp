/// Tests the promise kRelative (edge.hpp): the error does not change if all vertices of the edge undergo
/// one rigid motion of the plane. The gauge test believes it, so a false one loses what the edge anchors.
///
/// All functions are pure, so several threads may call them.
#pragma once

#include <string>

#include <waymark/core/base/export.hpp>
#include <waymark/core/graph/graph.hpp>

namespace WAYMARK_EXPORT waymark {

/// The largest change of an error by a rigid motion.
struct RelativeCheck {
  /// edges that were tried; 0 if the type does not say kRelative, or if a vertex has no rigid_motion()
  std::size_t edges = 0;
  /// the change, as a share of what the vertices would change if each moved alone
  double error = 0;
  std::size_t edge = 0;  ///< the edge with this error
  int row = 0;
  int motion = 0;     ///< 0: along x, 1: along y, 2: a turn about the first vertex
  double change = 0;  ///< of the row of the error, per m or per rad
};

/// A larger change is a false promise: rounding makes less than 1e-12.
inline constexpr double kRelativeTolerance = 1e-6;

/// Moves up to `most` edges of a batch (evenly spread) at the present values.
[[nodiscard]] RelativeCheck check_relative(const Graph& graph, std::size_t batch, std::size_t most);

/// Returns "it says kRelative, but row 0 of its error changes by 1 per m if all its vertices move along
/// x; ...", with a remedy.
[[nodiscard]] std::string describe(const RelativeCheck& check);
/// Returns the same with the edge in front: "EDGE_X number 3 (vertices 4 and 5): it says kRelative, ...".
[[nodiscard]] std::string describe(const Graph& graph, std::size_t batch, const RelativeCheck& check);

}  // namespace waymark
