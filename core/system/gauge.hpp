/// The gauge of a graph: the rigid motions of its parts that the edges cannot observe.
///
/// The result is a value. It is valid for the values and edges that the graph had.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/base/export.hpp>
#include <waymark/core/graph/graph.hpp>

namespace WAYMARK_EXPORT waymark {

/// What is left free of a component that is anchored in part.
struct PartlyFree {
  VertexIndex vertex = -1;       ///< one of the component
  RigidMotionView::Place place;  ///< of the component
  Eigen::MatrixXd motions;       ///< 3 x 1 or 3 x 2: what no edge sees, along x, along y and about the place
};

/// The vertices that are held so that the problem is determined, and the messages for the user.
struct Gauge {
  /// per vertex, a mark of held_marks.hpp: it keeps its value, or some coordinates of it (fixed vertices of the graph
  /// are not counted)
  std::vector<char> held;
  /// one sentence per component that was held; of very many like parts the first ones are named, and the others counted
  std::vector<std::string> messages;
  std::vector<PartlyFree> partly;  ///< one per component that is anchored in part
};

/// What to do with a component that is anchored in part.
enum class PartlyAnchored {
  hold_coordinates,  ///< hold as many coordinates of a vertex as there are motions that no edge sees
  hold_vertex        ///< hold its first vertex as a whole: more measurements will come
};

/// Examines every component of free vertices joined by edges. Its rigid-motion information is M =
/// sum (J T)^T Omega (J T), where T are the motions along x, along y and about the centre (scaled
/// by the extent). T moves a component in 3 ways; a single point in 2, because it turns about itself. The rank of M
/// decides:
/// - 0: nothing anchors the component. Its first vertex that has a heading is held, as usual in the field, and a
///   message says so.
/// - all: the component is anchored, and nothing is held.
/// - 1 or 2 of 3: it is anchored in part, if that is also the rank of the directions in which the edges are moved
///   (what is known to 1e4 m only is faint in M beside 1e-6 rad, but known). As many coordinates of its first vertex
///   with a heading are held as there are motions left: its heading beside a single fix, its place beside a single
///   heading. This costs nothing where no edge sees the motion, and a message says it.
/// @throws InputError for a component that is anchored in part only because of its present values (a parked car with
/// fixes, poses that all stand at one place), for one with stamps (the heading of a drive is a result), for a point
/// that is seen in one direction only, and for one that turns about any vertex that is held (points with distances
/// between them); it names a vertex and the missing measurement. With `hold_vertex` all of these are held
/// Time and memory grow with the vertices and edges, whatever the number of components.
[[nodiscard]] Gauge find_gauge(const Graph& graph, PartlyAnchored partly = PartlyAnchored::hold_coordinates);

/// Returns how many numbers the edges estimate: the coordinates of the free vertices with edges, less those that the
/// gauge holds. The degrees of freedom of chi2 are the measured numbers less these.
/// @param gauge of the graph
[[nodiscard]] std::int64_t count_unknowns(const Graph& graph, const Gauge& gauge);

}  // namespace waymark
