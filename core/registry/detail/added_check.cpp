#include <waymark/core/registry/detail/added_check.hpp>

#include <algorithm>
#include <cmath>
#include <span>

#include <waymark/core/graph/detail/edge_name.hpp>
#include <waymark/core/linear/dense_decompositions.hpp>

namespace waymark::detail {
namespace {

bool all_finite(std::span<const double> numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
}

std::string flaw_of_information(const Eigen::MatrixXd& information) {
  if (!information.allFinite()) return "its information is not finite";
  if (!is_positive_semidefinite(information))
    return "its information is indefinite (an eigenvalue below -1e-9 of the largest)";
  return "";
}

}  // namespace

AddedCheck::AddedCheck(const Graph& graph) : vertices_(graph.vertex_count()) {
  for (std::size_t b = 0; b < graph.batch_count(); ++b) edges_.push_back(graph.batch(b).size());
}

std::string AddedCheck::flaw(const Graph& graph) const {
  std::string found = flaw_of_vertices(graph);
  for (std::size_t b = 0; b < graph.batch_count() && found.empty(); ++b) found = flaw_of_edges(graph, b);
  return found;
}

std::string AddedCheck::flaw_of_vertices(const Graph& graph) const {
  for (std::size_t v = vertices_; v < graph.vertex_count(); ++v) {
    const auto vertex = static_cast<VertexIndex>(v);
    if (!all_finite(graph.value(vertex)))
      return graph.vertex_type(vertex).tag + " " + to_string(graph.id(vertex)) + ": its value is not finite";
  }
  return "";
}

std::string AddedCheck::flaw_of_edges(const Graph& graph, std::size_t b) const {
  const EdgeBatchBase& batch = graph.batch(b);
  std::vector<double> fields;
  for (std::size_t edge = b < edges_.size() ? edges_[b] : 0; edge < batch.size(); ++edge) {
    fields.clear();
    batch.fields(edge, fields);
    const std::string flaw =
        all_finite(fields) ? flaw_of_information(batch.information(edge)) : "a number of it is not finite";
    if (!flaw.empty()) return edge_name(graph, b, edge) + ": " + flaw;
    if (const Loss* loss = batch.loss(edge); loss != nullptr && loss->evaluate == nullptr)
      return edge_name(graph, b, edge) + ": its loss '" + loss->name + "' has no function";
  }
  return "";
}

}  // namespace waymark::detail
