#include <algorithm>
#include <map>
#include <utility>

#include <waymark/core/robust/chi_square.hpp>
#include <waymark/core/robust/trust.hpp>

namespace waymark {
namespace {

using Pair = std::pair<VertexIndex, VertexIndex>;

std::vector<VertexIndex> placed_vertices(const Graph& graph, EdgePlace place) {
  std::vector<VertexIndex> placed;
  for (const VertexIndex v : graph.batch(place.batch).vertices(place.edge)) {
    if (graph.vertex_type(v).position != nullptr) placed.push_back(v);
  }
  return placed;
}

/// Returns a graph of these edges without losses, whose only free vertex is `free`.
Graph graph_of(const Graph& graph, std::span<const EdgePlace> edges, VertexIndex free) {
  Graph result;
  std::map<VertexIndex, VertexIndex> copies;
  std::vector<VertexIndex> vertices;
  std::vector<double> fields;
  for (const EdgePlace place : edges) {
    const EdgeBatchBase& batch = graph.batch(place.batch);
    vertices.clear();
    for (const VertexIndex v : batch.vertices(place.edge)) {
      if (!copies.contains(v)) {
        copies[v] = result.add_vertex(graph.vertex_type(v), graph.id(v), graph.value(v));
        result.set_fixed(copies[v], v != free);
      }
      vertices.push_back(copies[v]);
    }
    fields.clear();
    batch.fields(place.edge, fields);
    result.add_edge(graph.edge_type(place.batch), vertices, fields, batch.information(place.edge));
  }
  return result;
}

bool contradict(const Graph& graph, std::span<const EdgePlace> edges, const Pair& pair, Algorithm& algorithm,
                LinearSolver& solver, double probability) {
  const VertexIndex free = graph.fixed(pair.second) ? pair.first : pair.second;
  if (graph.fixed(free)) return false;
  Graph alone = graph_of(graph, edges, free);
  int freedom = -graph.vertex_type(free).tangent_size;
  for (const EdgePlace place : edges) freedom += graph.batch(place.batch).error_dimension(place.edge);
  if (freedom < 1) return false;
  const Summary summary = optimize(alone, algorithm, solver, {});
  return !(summary.final_chi2 <= chi_square_quantile(probability, freedom));
}

}  // namespace

TrustRule trust_each(std::function<bool(const Graph&, EdgePlace)> is_trusted) {
  return [is_trusted = std::move(is_trusted)](const Graph& graph) {
    std::vector<EdgePlace> result;
    for (std::size_t b = 0; b < graph.batch_count(); ++b)
      for (std::size_t e = 0; e < graph.batch(b).size(); ++e)
        if (is_trusted(graph, {b, e})) result.push_back({b, e});
    return result;
  };
}

std::vector<std::vector<EdgePlace>> contradicting_parallels(const Graph& graph,
                                                            std::span<const EdgePlace> trusted,
                                                            Algorithm& algorithm, LinearSolver& solver,
                                                            double probability) {
  std::map<Pair, std::vector<EdgePlace>> between;
  for (const EdgePlace place : trusted) {
    if (graph.edge_type(place.batch).arity == EdgeType::kRuntimeArity) continue;
    const std::vector<VertexIndex> placed = placed_vertices(graph, place);
    if (placed.size() == 2) between[std::minmax(placed[0], placed[1])].push_back(place);
  }
  std::vector<std::vector<EdgePlace>> result;
  for (const auto& [pair, edges] : between) {
    if (edges.size() > 1 && contradict(graph, edges, pair, algorithm, solver, probability))
      result.push_back(edges);
  }
  return result;
}

}  // namespace waymark
