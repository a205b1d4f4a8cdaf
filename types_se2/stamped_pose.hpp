/// Finds the poses of a trajectory among the vertices of a graph.
#pragma once

#include <optional>

#include <waymark/core/drive/sample.hpp>
#include <waymark/core/graph/graph.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

namespace waymark {

/// Returns a vertex as a pose of the trajectory. The result is empty if the vertex is no VERTEX_SE2
/// or has no stamp.
[[nodiscard]] inline std::optional<StampedPose> stamped_pose(const Graph& graph, VertexIndex v) {
  const auto stamp = graph.stamp(v);
  if (!stamp || graph.vertex_type(v).tag != VertexSe2::kTag) return std::nullopt;
  const auto value = graph.value(v);
  return StampedPose{*stamp, Eigen::Vector3d(value[0], value[1], value[2])};
}

}  // namespace waymark
