#include <waymark/core/graph/checks/finite_check.hpp>

#include <algorithm>
#include <cmath>

#include <waymark/core/graph/detail/edge_name.hpp>

namespace waymark {
namespace {

/// Returns what of an edge is not finite; empty: nothing.
std::string flaw_of(const Graph& graph, const EdgeBatchBase& batch, std::size_t edge) {
  Eigen::VectorXd error;
  std::vector<Eigen::MatrixXd> jacobians;
  const Eigen::MatrixXd information = batch.information(edge);
  if (!information.allFinite()) return "its information";
  batch.linearize_edge(edge, graph.view(), error, jacobians);
  if (!error.allFinite()) return "its error";
  const bool finite = std::all_of(jacobians.begin(), jacobians.end(),
                                  [](const Eigen::MatrixXd& jacobian) { return jacobian.allFinite(); });
  if (!finite) return "its Jacobian";
  const double squared = error.dot(information * error);
  if (!std::isfinite(squared)) return "its squared error";
  const Loss* loss = batch.loss(edge);
  if (loss == nullptr) return "";
  const LossValue value = loss->at(std::max(0.0, squared));
  const bool good = std::isfinite(value.rho) && std::isfinite(value.weight) && std::isfinite(value.curvature);
  return good ? "" : "its loss '" + loss->name + "'";
}

/// Every edge is finite. Returns the one with the largest information if their sum is not.
std::optional<std::string> find_overflow(const Graph& graph) {
  double sum = 0;
  double largest = 0;
  std::string name;
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    for (std::size_t edge = 0; edge < graph.batch(b).size(); ++edge) {
      const double information = graph.batch(b).information(edge).cwiseAbs().maxCoeff();
      sum += information;
      if (!(information > largest)) continue;
      largest = information;
      name = detail::edge_name(graph, b, edge);
    }
  }
  if (std::isfinite(sum)) return std::nullopt;
  return name + ": its information is the largest, and the sum over the edges is not finite";
}

}  // namespace

std::optional<std::string> find_not_finite(const Graph& graph) {
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    const auto value = graph.value(v);
    if (!std::all_of(value.begin(), value.end(), [](double x) { return std::isfinite(x); }))
      return graph.vertex_type(v).tag + " " + to_string(graph.id(v)) + ": its value is not finite";
  }
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    const EdgeBatchBase& batch = graph.batch(b);
    for (std::size_t edge = 0; edge < batch.size(); ++edge) {
      const std::string flaw = flaw_of(graph, batch, edge);
      if (flaw.empty()) continue;
      return detail::edge_name(graph, b, edge) + ": " + flaw + " is not finite";
    }
  }
  return find_overflow(graph);
}

}  // namespace waymark
