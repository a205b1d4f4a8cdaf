#include <algorithm>
#include <array>
#include <cstdint>

#include <waymark/core/base/detail/disjoint_sets.hpp>
#include <waymark/core/base/detail/index.hpp>
#include <waymark/core/robust/detail/ways.hpp>

namespace waymark::detail {
namespace {

/// The edges at a vertex, as long as they are two of `edges`.
struct Inner {
  std::array<std::int32_t, 2> edges{-1, -1};
  int count = 0;  // of all edges at it
};

/// Tells whether an edge determines each of its two ends from the other.
bool determines_ends(const Graph& graph, EdgePlace place) {
  const EdgeBatchBase& batch = graph.batch(place.batch);
  const std::span<const VertexIndex> ends = batch.vertices(place.edge);
  return ends.size() == 2 && std::all_of(ends.begin(), ends.end(), [&](VertexIndex v) {
           return graph.vertex_type(v).tangent_size == batch.error_dimension(place.edge);
         });
}

/// @return per vertex
std::vector<Inner> describe_vertices(const Graph& graph, std::span<const EdgePlace> edges,
                                     std::span<const EdgePlace> outside) {
  std::vector<Inner> result(graph.vertex_count());
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    for (std::size_t e = 0; e < graph.batch(b).size(); ++e) {
      const EdgePlace place{b, e};
      if (std::binary_search(outside.begin(), outside.end(), place)) continue;
      const auto known = std::lower_bound(edges.begin(), edges.end(), place);
      const bool serves = known != edges.end() && *known == place && determines_ends(graph, place);
      for (const VertexIndex v : graph.batch(b).vertices(e)) {
        Inner& inner = result[at(v)];
        if (serves && inner.count < 2)
          inner.edges[at(inner.count)] = static_cast<std::int32_t>(known - edges.begin());
        ++inner.count;
      }
    }
  }
  return result;
}

}  // namespace

std::vector<std::vector<EdgePlace>> by_way(const Graph& graph, std::span<const EdgePlace> edges,
                                           std::span<const EdgePlace> outside) {
  const std::vector<Inner> vertices = describe_vertices(graph, edges, outside);
  DisjointSets ways(edges.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const auto& [pair, count] = vertices[v];
    if (count == 2 && pair[0] >= 0 && pair[1] >= 0 && !graph.fixed(static_cast<VertexIndex>(v)))
      (void)ways.join(pair[0], pair[1]);
  }
  std::vector<std::vector<EdgePlace>> result(edges.size());  // by the name of the way
  for (std::size_t i = 0; i < edges.size(); ++i)
    result[at(ways.of(static_cast<std::int32_t>(i)))].push_back(edges[i]);
  std::erase_if(result, [](const std::vector<EdgePlace>& way) { return way.empty(); });
  return result;
}

}  // namespace waymark::detail
