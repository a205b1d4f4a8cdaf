#include <algorithm>
#include <map>
#include <string_view>
#include <utility>

#include <waymark/core/base/detail/index.hpp>
#include <waymark/core/robust/detail/id_order.hpp>

namespace waymark::detail {

std::vector<std::vector<VertexIndex>> sequences_by_id(const Graph& graph) {
  std::map<std::string_view, std::vector<VertexIndex>> by_type;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v)
    by_type[graph.vertex_type(v).tag].push_back(v);
  std::vector<std::vector<VertexIndex>> result;
  for (auto& [tag, vertices] : by_type) {
    std::sort(vertices.begin(), vertices.end(),
              [&](VertexIndex a, VertexIndex b) { return graph.id(a) < graph.id(b); });
    result.push_back(std::move(vertices));
  }
  return result;
}

std::vector<std::int64_t> places_by_id(const Graph& graph) {
  constexpr std::int64_t kApart = 1000;
  std::vector<std::int64_t> result(graph.vertex_count());
  std::int64_t place = 0;
  for (const std::vector<VertexIndex>& sequence : sequences_by_id(graph)) {
    for (const VertexIndex v : sequence) result[at(v)] = place++;
    place += kApart;
  }
  return result;
}

}  // namespace waymark::detail
