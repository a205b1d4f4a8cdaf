/// Relations: the measurements of edges between poses and points of the plane, in one form. The
/// form is linear in positions and unit complex numbers, as linear initialisation needs it.
#pragma once

#include <vector>

#include <Eigen/Core>

#include <waymark/core/graph/graph.hpp>

namespace waymark {

/// `to` seen from `from`. With c = (cos heading, sin heading) read as a complex number, and p also
/// read as one,
///   position   p_to + c_to * lever = p_from + c_from * translation
///   heading    c_to = c_from * exp(i turn)
/// Metres and radians. A point (VERTEX_XY) has no c, and its lever is zero.
struct Relation {
  static constexpr VertexIndex kWorld = -1;  ///< as `from`: the frame itself, p = 0, c = 1

  VertexIndex from = kWorld;
  VertexIndex to = kWorld;
  Eigen::Vector2d translation = Eigen::Vector2d::Zero();  ///< in the axes of `from`
  Eigen::Vector2d lever = Eigen::Vector2d::Zero();        ///< in the axes of `to`
  double turn = 0;
  /// mean information per axis, 1/m^2; 0: the edge does not measure the position
  double position_weight = 0;
  double heading_weight = 0;  ///< 1/rad^2; 0: the edge does not measure the heading

  /// Tells whether the pose at one end determines the pose at the other.
  [[nodiscard]] bool is_motion() const { return position_weight > 0 && heading_weight > 0; }
};

/// Returns the relations of a graph, batch by batch. EDGE_SE2, EDGE_SE2_LOG, EDGE_GNSS_POSITION,
/// EDGE_PRIOR_SE2, EDGE_PRIOR_SE2_XY and EDGE_PRIOR_XY are read from their fields, sightings with a
/// range from their sights. An edge of another type counts if it joins two poses and has a
/// three-dimensional error. It may also join vertices that are no poses; these keep their present
/// values. Its motion is the one at which the error vanishes; Newton's method finds it. All other
/// edges are left out. Losses are ignored.
[[nodiscard]] std::vector<Relation> planar_relations(const Graph& graph);

}  // namespace waymark
