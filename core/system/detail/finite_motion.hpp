/// Rigid motions of the plane of any size, of vertices of any type that takes part in them.
#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

#include <waymark/core/graph/graph.hpp>

namespace waymark::detail {

/// A turn about the origin, then a shift.
struct FiniteMotion {
  double turn = 0;
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();

  [[nodiscard]] Eigen::Vector2d of(const Eigen::Vector2d& point) const;
};

/// Moves a vertex of a type with rigid_motion; others stay.
void move(Graph& graph, VertexIndex v, const FiniteMotion& motion);

/// Returns the motion of some vertices of an edge that makes its error smallest, found from their present
/// values.
/// @param graph with the vertices; it gets its values back @param moved those vertices
/// @return nothing if it is not finite
[[nodiscard]] std::optional<FiniteMotion> motion_to_agree(const EdgeBatchBase& batch, std::size_t edge,
                                                          Graph& graph, std::span<const VertexIndex> moved);

}  // namespace waymark::detail
