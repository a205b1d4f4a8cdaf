/// Sightings: which pose saw which point where. They come from the sights of edges (core/base/sight.hpp).
#pragma once

#include <vector>

#include <waymark/core/graph/graph.hpp>

namespace waymark {

struct Sighting {
  VertexIndex from = -1;  ///< a pose (VERTEX_SE2)
  VertexIndex to = -1;    ///< a point (VERTEX_XY)
  Sight sight;
  /// mean information per axis about the place of the point, 1/m^2; 0 without a range or a bearing
  double position_weight = 0;
};

/// Returns the sightings of a graph, batch by batch. Losses are ignored.
[[nodiscard]] std::vector<Sighting> planar_sightings(const Graph& graph);

}  // namespace waymark
