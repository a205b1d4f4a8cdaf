/// The components of a graph, and how the rigid motions of the plane move their vertices.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/graph/graph.hpp>

namespace waymark::detail {

/// Returns per vertex the first vertex of its component: free vertices that edges join.
[[nodiscard]] std::vector<std::int32_t> find_components(const Graph& graph);

/// The components of the vertices that a rigid motion moves.
struct Components {
  std::vector<std::int32_t> of;    // per vertex; -1: the vertex is fixed or does not move
  std::vector<VertexIndex> next;   // per vertex: the next one of its component; -1: it is the last
  std::vector<VertexIndex> first;  // first vertex with edges
  std::vector<VertexIndex> pose;   // first vertex that a turn about itself changes; -1: all are points
  std::vector<int> count;          // vertices that move
  std::vector<char> stamped;       // not 0: one of them has a stamp
  std::vector<RigidMotionView::Place> places;
};

/// Describes the components of vertices with edges.
[[nodiscard]] Components describe_components(const Graph& graph);

/// Returns how a rigid motion about a centre moves a vertex: its tangent by x and y (per metre) and the turn
/// (per metre at the extent).
[[nodiscard]] Eigen::MatrixXd motion_of(const Graph& graph, VertexIndex v,
                                        const RigidMotionView::Place& place);

/// Returns how a turn about the place of a vertex moves its tangent: not at all for a point.
[[nodiscard]] Eigen::VectorXd own_turn(const Graph& graph, VertexIndex v);

}  // namespace waymark::detail
