#include <waymark/core/graph/detail/edge_name.hpp>

namespace waymark::detail {
namespace {

std::string joined_ids(const Graph& graph, std::span<const VertexIndex> vertices) {
  std::string text;
  for (std::size_t k = 0; k < vertices.size(); ++k)
    text += (k == 0 ? "" : k + 1 == vertices.size() ? " and " : ", ") + to_string(graph.id(vertices[k]));
  return (vertices.size() == 1 ? "vertex " : "vertices ") + text;
}

}  // namespace

std::string edge_name(const Graph& graph, std::size_t batch, std::size_t edge) {
  return graph.edge_type(batch).tag + " number " + std::to_string(edge + 1) + " (" +
         joined_ids(graph, graph.batch(batch).vertices(edge)) + ")";
}

}  // namespace waymark::detail
