/// The order of vertices by their ids, whatever steps the ids make.
#pragma once

#include <cstdint>
#include <vector>

#include <waymark/core/graph/graph.hpp>

namespace waymark::detail {

/// Returns the vertices of each type by ascending ids. Ids of keyframes leave many out, and landmarks lie
/// between those of poses.
[[nodiscard]] std::vector<std::vector<VertexIndex>> sequences_by_id(const Graph& graph);

/// Returns the place of each vertex in the sequence of its type, those of different types far apart.
[[nodiscard]] std::vector<std::int64_t> places_by_id(const Graph& graph);

}  // namespace waymark::detail
