#include <waymark/core/system/detail/incidence.hpp>

namespace waymark {

std::vector<char> vertices_with_edges(const Graph& graph) {
  std::vector<char> has_edge(graph.vertex_count(), 0);
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    for_each_edge(graph.batch(b), [&](std::span<const VertexIndex> vertices) {
      for (const VertexIndex v : vertices) has_edge[static_cast<std::size_t>(v)] = 1;
    });
  }
  return has_edge;
}

}  // namespace waymark
