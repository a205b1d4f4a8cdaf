#include <waymark/core/incidence.hpp>

namespace waymark {

std::vector<char> vertices_with_edges(const Graph& graph) {
  std::vector<char> has_edge(graph.vertex_count(), 0);
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    const EdgeBatchBase& batch = graph.batch(b);
    for (std::size_t e = 0; e < batch.size(); ++e) {
      for (const VertexIndex v : batch.vertices(e)) has_edge[static_cast<std::size_t>(v)] = 1;
    }
  }
  return has_edge;
}

}  // namespace waymark
