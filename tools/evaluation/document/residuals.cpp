#include <waymark/tools/evaluation/document/residuals.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <waymark/core/linear/dense_decompositions.hpp>

namespace waymark::evaluation {
namespace {

/// Computes w of an error, see the header. @return as many numbers as `error` has
Eigen::VectorXd whiten(const Eigen::MatrixXd& information, const Eigen::VectorXd& error) {
  const Eigen::VectorXd scale = information.diagonal().cwiseMax(0).cwiseSqrt();
  Eigen::VectorXd scaled = scale.cwiseProduct(error);
  if (!information.isDiagonal(0)) {
    const Eigen::VectorXd inverse = (scale.array() > 0).select(scale.cwiseInverse(), 0);
    const Eigen::MatrixXd correlation = inverse.asDiagonal() * information * inverse.asDiagonal();
    const auto [squares, axes] = symmetric_eigen(correlation);
    const Eigen::VectorXd roots = squares.cwiseMax(0).cwiseSqrt();
    scaled = axes * roots.asDiagonal() * (axes.transpose() * scaled);
  }
  for (Eigen::Index k = 0; k < scaled.size(); ++k) {
    if (!(scale[k] > 0)) scaled[k] = kUndefined;
  }
  return scaled;
}

std::vector<std::string> split_at_commas(const std::string& form) {
  std::vector<std::string> words;
  std::size_t begin = 0;
  for (std::size_t comma = 0; comma != std::string::npos; begin = comma + 2) {
    comma = form.find(", ", begin);
    words.push_back(form.substr(begin, comma == std::string::npos ? comma : comma - begin));
  }
  return words;
}

/// Returns the names of the components of a batch's errors, by the form of the error.
std::vector<std::string> component_names(const Graph& graph, std::size_t batch, std::size_t dimension) {
  const std::string& form = graph.edge_type(batch).form;
  const VertexType& first = graph.vertex_type(graph.batch(batch).vertices(0).front());
  if (form == "difference" && first.value_names.size() == dimension) return first.value_names;
  if (dimension == 3 && (form == "log" || form == "(t, theta)")) return {"x", "y", "heading"};
  if (dimension == 2 && (form == "position" || form == "body frame" || form == "sensor frame"))
    return {"x", "y"};
  if (std::vector<std::string> words = split_at_commas(form); words.size() == dimension && !form.empty())
    return words;
  std::vector<std::string> numbers;
  for (std::size_t k = 1; k <= dimension; ++k) numbers.push_back(std::to_string(k));
  return numbers;
}

EdgeRole role_of(const Graph& graph, std::size_t batch) {
  if (graph.edge_type(batch).tag == GaussianPriorBatch::kTag) return EdgeRole::prior;
  const auto vertices = graph.batch(batch).vertices(0);
  const auto has_place = [&](VertexIndex v) { return graph.vertex_type(v).position != nullptr; };
  if (std::any_of(vertices.begin(), vertices.end(), has_place)) return EdgeRole::measurement;
  return vertices.size() > 1 ? EdgeRole::process : EdgeRole::measurement;
}

/// Adds the errors of all edges of a batch.
void add_edges(const Graph& graph, std::size_t b, TypeResiduals& type) {
  const EdgeBatchBase& batch = graph.batch(b);
  for (std::size_t i = 0; i < batch.size(); ++i)
    type.dimension = std::max(type.dimension, static_cast<std::size_t>(batch.error_dimension(i)));
  type.edges.reserve(batch.size());
  type.whitened.assign(batch.size() * type.dimension, kUndefined);
  Eigen::VectorXd error;
  std::vector<Eigen::MatrixXd> jacobians;
  for (std::size_t i = 0; i < batch.size(); ++i) {
    batch.linearize_edge(i, graph.view(), error, jacobians);
    const Eigen::MatrixXd information = batch.information(i);
    const Eigen::VectorXd whitened = whiten(information, error);
    std::copy(whitened.begin(), whitened.end(),
              type.whitened.begin() + static_cast<std::ptrdiff_t>(i * type.dimension));
    EdgeResidual& edge = type.edges.emplace_back();
    edge.edge = i;
    edge.stamp = latest_stamp(graph, batch.vertices(i));
    edge.squared = edge.rho = error.dot(information * error);
    if (const Loss* loss = batch.loss(i)) {
      const LossValue value = loss->at(std::max(0.0, edge.squared));
      edge.rho = value.rho;
      edge.weight = value.weight;
      ++type.robust;
    }
    type.squared += edge.squared;
    type.chi2 += edge.rho;
    type.weight_sum += edge.weight;
  }
}

void add_statistics(const Graph& graph, std::size_t b, TypeResiduals& type) {
  std::vector<double> values;
  for (const std::string& name : component_names(graph, b, type.dimension)) {
    const std::size_t k = type.components.size();
    values.clear();
    for (std::size_t at = k; at < type.whitened.size(); at += type.dimension) {
      if (!std::isnan(type.whitened[at])) values.push_back(type.whitened[at]);
    }
    type.components.push_back({name, scalar_statistics(values)});
  }
}

void list_largest(const Graph& graph, std::size_t b, std::size_t most, TypeResiduals& type) {
  std::vector<std::size_t> order(type.edges.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto listed = order.begin() + static_cast<std::ptrdiff_t>(std::min(most, order.size()));
  std::partial_sort(order.begin(), listed, order.end(), [&](std::size_t a, std::size_t c) {
    if (type.edges[a].squared != type.edges[c].squared) return type.edges[a].squared > type.edges[c].squared;
    return a < c;
  });
  for (auto place = order.begin(); place != listed; ++place) {
    LargeResidual& large = type.largest.emplace_back();
    large.residual = type.edges[*place];
    for (const VertexIndex v : graph.batch(b).vertices(*place)) large.vertices.push_back(graph.id(v));
    const auto dimension = static_cast<std::size_t>(graph.batch(b).error_dimension(*place));
    const auto first = type.whitened.begin() + static_cast<std::ptrdiff_t>(*place * type.dimension);
    large.whitened.assign(first, first + static_cast<std::ptrdiff_t>(dimension));
  }
}

}  // namespace

const char* to_string(EdgeRole role) {
  switch (role) {
    case EdgeRole::measurement:
      return "measurement";
    case EdgeRole::process:
      return "process";
    case EdgeRole::prior:
      return "prior";
  }
  return "";
}

double GraphResiduals::expected_rms(std::int64_t unknowns) const {
  const auto all = static_cast<double>(components);
  return components > 0 ? std::sqrt(std::max(0.0, 1 - static_cast<double>(unknowns) / all)) : 0;
}

std::optional<Stamp> latest_stamp(const Graph& graph, std::span<const VertexIndex> vertices) {
  std::optional<Stamp> latest;
  for (const VertexIndex v : vertices) {
    if (const auto stamp = graph.stamp(v)) latest = latest ? std::max(*latest, *stamp) : *stamp;
  }
  return latest;
}

GraphResiduals residuals_by_type(const Graph& graph, std::size_t most) {
  GraphResiduals result;
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    if (graph.batch(b).size() == 0) continue;
    TypeResiduals& type = result.types.emplace_back();
    type.tag = graph.edge_type(b).tag;
    type.form = graph.edge_type(b).form;
    type.role = role_of(graph, b);
    add_edges(graph, b, type);
    add_statistics(graph, b, type);
    list_largest(graph, b, most, type);
    result.squared += type.squared;
    result.chi2 += type.chi2;
    for (const ResidualComponent& component : type.components)
      result.components += component.statistics.count;
  }
  for (TypeResiduals& type : result.types) {
    if (result.squared > 0) type.squared_share = type.squared / result.squared;
    if (result.chi2 > 0) type.chi2_share = type.chi2 / result.chi2;
  }
  return result;
}

}  // namespace waymark::evaluation
