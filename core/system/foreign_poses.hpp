/// Poses of other spaces than the plane: a plugin's SE(3), for example.
#pragma once

#include <waymark/core/base/export.hpp>
#include <waymark/core/graph/graph.hpp>

namespace WAYMARK_EXPORT waymark {

/// Tells whether a type is one of poses that are not of the plane: it has three degrees of freedom or more,
/// no place in the plane (VertexType::position), and is no state (its numbers have no units). The starts
/// of the plane cannot place them, and the gauge cannot ask them for rigid motions.
[[nodiscard]] inline bool is_foreign_pose(const VertexType& type) {
  return type.tangent_size >= 3 && type.position == nullptr && type.value_units.empty() && !type.dense;
}

/// Returns a vertex of such a type that an edge joins to another one of the same type; -1: there is none.
[[nodiscard]] inline VertexIndex find_joined_foreign_pose(const Graph& graph) {
  VertexIndex found = -1;
  for (std::size_t b = 0; b < graph.batch_count() && found < 0; ++b) {
    for_each_edge(graph.batch(b), [&](std::span<const VertexIndex> vertices) {
      if (found >= 0 || vertices.size() < 2) return;
      const VertexType& type = graph.vertex_type(vertices[0]);
      if (is_foreign_pose(type) && graph.vertex_type(vertices[1]).tag == type.tag) found = vertices[0];
    });
  }
  return found;
}

}  // namespace waymark
