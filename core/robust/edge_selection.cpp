#include <algorithm>
#include <limits>

#include <waymark/core/base/detail/disjoint_sets.hpp>
#include <waymark/core/base/detail/index.hpp>
#include <waymark/core/linear/dense_decompositions.hpp>
#include <waymark/core/linear/detail/information_root.hpp>
#include <waymark/core/linear/inverse_form.hpp>
#include <waymark/core/robust/edge_selection.hpp>
#include <waymark/core/system/detail/components.hpp>
#include <waymark/core/system/detail/incidence.hpp>
#include <waymark/core/system/gauge.hpp>
#include <waymark/core/system/held_marks.hpp>
#include <waymark/core/system/normal_equations.hpp>

namespace waymark {

double squared_error(const Graph& graph, EdgePlace place) {
  const EdgeBatchBase& batch = graph.batch(place.batch);
  Eigen::VectorXd e;
  std::vector<Eigen::MatrixXd> jacobians;
  batch.linearize_edge(place.edge, graph.view(), e, jacobians);
  return e.dot(batch.information(place.edge) * e);
}

Graph without_edges(const Graph& graph, std::span<const EdgePlace> edges) {
  Graph result;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    result.add_vertex(graph.vertex_type(v), graph.id(v), graph.value(v));
    if (graph.fixed(v)) result.set_fixed(v, true);
    if (const auto stamp = graph.stamp(v)) result.set_stamp(v, *stamp);
  }
  std::vector<double> fields;
  auto next = edges.begin();
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    const EdgeBatchBase& from = graph.batch(b);
    EdgeBatchBase& to = result.batch(graph.edge_type(b));
    if (const Loss* loss = from.batch_loss()) to.set_loss(*loss);
    for (std::size_t e = 0; e < from.size(); ++e) {
      if (next != edges.end() && *next == EdgePlace{b, e}) {
        ++next;
        continue;
      }
      fields.clear();
      from.fields(e, fields);
      result.add_edge(graph.edge_type(b), from.vertices(e), fields, from.information(e));
      if (const Loss* loss = from.loss(e); loss != from.batch_loss()) to.set_loss(to.size() - 1, *loss);
    }
  }
  return result;
}

std::vector<Innovation> innovations(const Graph& graph, std::span<const EdgePlace> edges,
                                    Membership membership, const Graph& kept) {
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  std::vector<Innovation> result(edges.size(), {kUnknown, kUnknown});
  if (edges.empty()) return result;
  Structure structure;
  structure.build(kept, find_gauge(kept).held);
  NormalEquations equations(kept, structure);
  (void)equations.linearize(kept.values());
  BlockCholesky cholesky;
  cholesky.analyze(structure.pattern());
  if (cholesky.factorize(equations.hessian()) != FactorStatus::ok) return result;
  InverseForm form(cholesky);
  Eigen::VectorXd e;
  std::vector<Eigen::MatrixXd> jacobians;
  std::vector<BlockRow> rows;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const EdgeBatchBase& batch = graph.batch(edges[i].batch);
    const std::span<const VertexIndex> vertices = batch.vertices(edges[i].edge);
    batch.linearize_edge(edges[i].edge, kept.view(), e, jacobians);
    rows.clear();
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      const int column = structure.column_of(vertices[k]);
      if (column >= 0) rows.push_back({column, jacobians[k].transpose()});
    }
    const Eigen::MatrixXd predicted =
        rows.empty() ? Eigen::MatrixXd::Zero(e.size(), e.size()) : form(rows);  // J P J^T
    // With Omega = A^T A: (Omega^-1 + C)^-1 = A^T (I + A C A^T)^-1 A also holds if Omega is singular.
    const Eigen::MatrixXd root = information_root(batch.information(edges[i].edge));
    result[i] = {0, 0};
    if (root.rows() == 0) continue;
    const double sign = membership == Membership::outside ? 1 : -1;
    const auto [spread, directions] = symmetric_eigen(Eigen::MatrixXd::Identity(root.rows(), root.rows()) +
                                                      sign * root * predicted * root.transpose());
    // For an edge inside, directions that no other edge knows leave no spread, and rounding
    // would decide.
    const bool checked = membership == Membership::outside || spread[0] > 1e-9 * spread[root.rows() - 1];
    const Eigen::VectorXd along = directions.transpose() * (root * e);
    if (checked) result[i].squared = along.cwiseAbs2().cwiseQuotient(spread).sum();
    result[i].looseness = 0.5 * spread.array().max(std::numeric_limits<double>::min()).log().sum();
  }
  return result;
}

namespace {

using detail::at;

/// The parts of a graph that its edges join, and that further edges would join.
class Parts {
 public:
  explicit Parts(const Graph& graph)
      : fixed_(static_cast<std::int32_t>(graph.vertex_count())),
        sets_(graph.vertex_count() + 1),
        motions_(graph.vertex_count() + 1, 0) {
    const std::vector<std::int32_t> component = detail::find_components(graph);
    const std::vector<char> held = find_gauge(graph, PartlyAnchored::hold_vertex).held;
    const std::vector<char> has_edge = vertices_with_edges(graph);
    for (VertexIndex v = 0; v < fixed_; ++v) {
      const std::int32_t part = sets_.join(v, graph.fixed(v) ? fixed_ : component[at(v)]);
      if (graph.fixed(v)) continue;
      if (has_edge[at(v)] == 0)
        motions_[at(part)] = graph.vertex_type(v).tangent_size;
      else if (is_wholly_held(held[at(v)]))
        motions_[at(part)] = kOfPoses;
    }
  }

  /// Joins the parts of two vertices, if one of them may be moved so that an error becomes zero.
  /// @param dimension of the error
  bool join(std::span<const VertexIndex> vertices, int dimension) {
    if (vertices.size() != 2) return false;
    const std::int32_t one = sets_.of(vertices[0]);
    const std::int32_t other = sets_.of(vertices[1]);
    if (one == other) return false;
    // The one that is moved loses its motions. 0: nothing moves it.
    const auto [fewer, more] = std::minmax(motions_[at(one)], motions_[at(other)]);
    const int of_moved = fewer == 0 ? more : fewer;
    if (of_moved == 0 || dimension < of_moved) return false;
    motions_[at(sets_.join(one, other))] = fewer == 0 ? 0 : more;
    return true;
  }

 private:
  static constexpr int kOfPoses = 3;

  std::int32_t fixed_;  // stands for all fixed vertices
  detail::DisjointSets sets_;
  std::vector<int> motions_;  // of each part, by its name: how many rigid ones nothing stops
};

}  // namespace

std::vector<EdgePlace> joining_edges(const Graph& graph, std::span<const EdgePlace> edges,
                                     const Graph& kept) {
  Parts parts(kept);
  std::vector<EdgePlace> result;
  for (const EdgePlace place : edges) {
    const EdgeBatchBase& batch = graph.batch(place.batch);
    if (parts.join(batch.vertices(place.edge), batch.error_dimension(place.edge))) result.push_back(place);
  }
  return result;
}

}  // namespace waymark
