#include <algorithm>

#include <waymark/formats/graph/graph_document.hpp>

namespace waymark::formats {

std::vector<DocumentSource> receivers_of(const GraphDocument& document) {
  std::vector<DocumentSource> receivers;
  for (const DocumentSource& source : document.sources)
    if (source.kind == "gnss") receivers.push_back(source);
  return receivers;
}

bool has_vertex(const DocumentSource& source, VertexId vertex) {
  return std::any_of(source.vertices.begin(), source.vertices.end(),
                     [&](const VertexRange& range) { return vertex >= range.first && vertex <= range.last; });
}

std::string source_of(VertexId vertex, const GraphDocument& document) {
  for (const DocumentSource& source : document.sources)
    if (has_vertex(source, vertex)) return source.name;
  return {};
}

void place_antennas(GraphDocument& document) {
  const std::vector<DocumentSource> receivers = receivers_of(document);
  for (Fix& fix : document.fixes) {
    const auto source = static_cast<std::size_t>(fix.source);
    fix.antenna_m = source < receivers.size() ? receivers[source].antenna_m : document.antenna_m;
  }
}

}  // namespace waymark::formats
