/// What the edges of a graph say about poses and points of the plane, in one form that is linear in positions
/// and unit complex numbers (the form that linear initialisation needs).
#pragma once

#include <vector>

#include <Eigen/Core>

#include <waymark/core/graph/graph.hpp>

namespace waymark {

/// `to` seen from `from`: with c = (cos heading, sin heading) read as a complex number, p as one too,
///   position   p_to + c_to * lever = p_from + c_from * translation
///   heading    c_to = c_from * exp(i turn)
/// Metres and radians. A point (VERTEX_XY) has no c; its lever is zero.
struct Relation {
  static constexpr VertexIndex kWorld = -1;  ///< `from`: the frame itself, p = 0, c = 1

  VertexIndex from = kWorld;
  VertexIndex to = kWorld;
  Eigen::Vector2d translation = Eigen::Vector2d::Zero();  ///< in the axes of `from`
  Eigen::Vector2d lever = Eigen::Vector2d::Zero();        ///< in the axes of `to`
  double turn = 0;
  double position_weight = 0;  ///< mean information per axis, 1/m^2; 0: says nothing of the position
  double heading_weight = 0;   ///< 1/rad^2; 0: says nothing of the heading

  /// Whether the pose at one end gives that at the other.
  [[nodiscard]] bool is_motion() const { return position_weight > 0 && heading_weight > 0; }
};

/// The relations of a graph, batch by batch. EDGE_SE2, EDGE_SE2_LOG, EDGE_GNSS_POSITION, EDGE_PRIOR_SE2,
/// EDGE_SE2_XY, EDGE_PRIOR_SE2_XY, EDGE_PRIOR_XY and EDGE_SE2_POINTXY_OFFSET are read from their fields. Of
/// any other type, edges over two poses (and perhaps vertices that are no pose, at their present values) with
/// a three-dimensional error count: their motion is where the error vanishes, found by Newton's method. All
/// else says nothing here. Losses are ignored.
[[nodiscard]] std::vector<Relation> planar_relations(const Graph& graph);

}  // namespace waymark
