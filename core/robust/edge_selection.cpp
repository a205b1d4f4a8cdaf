#include <limits>
#include <numeric>
#include <utility>

#include <waymark/core/linear/dense_decompositions.hpp>
#include <waymark/core/linear/detail/information_root.hpp>
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

std::vector<double> innovations(const Graph& graph, std::span<const EdgePlace> edges, Membership membership,
                                const Graph& kept, LinearSolver& solver) {
  std::vector<double> result(edges.size(), std::numeric_limits<double>::infinity());
  if (edges.empty()) return result;
  Structure structure;
  structure.build(kept, find_gauge(kept).held);
  NormalEquations equations(kept, structure);
  (void)equations.linearize(kept.values());
  const BlockPattern& pattern = structure.pattern();
  const auto unknowns = static_cast<Eigen::Index>(pattern.dimension());
  if (unknowns > 0) {
    solver.analyze(pattern);
    if (solver.factorize(equations.hessian()) != FactorStatus::ok) return result;
  }
  Eigen::VectorXd e;
  std::vector<Eigen::MatrixXd> jacobians;
  Eigen::VectorXd row(unknowns);
  Eigen::VectorXd solved(unknowns);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const EdgeBatchBase& batch = graph.batch(edges[i].batch);
    const std::span<const VertexIndex> vertices = batch.vertices(edges[i].edge);
    batch.linearize_edge(edges[i].edge, kept.view(), e, jacobians);
    // J P J^T, one row of J at a time.
    Eigen::MatrixXd predicted = Eigen::MatrixXd::Zero(e.size(), e.size());
    for (Eigen::Index r = 0; r < e.size() && unknowns > 0; ++r) {
      row.setZero();
      for (std::size_t k = 0; k < vertices.size(); ++k) {
        const int column = structure.column_of(vertices[k]);
        if (column < 0) continue;
        row.segment(pattern.start[static_cast<std::size_t>(column)], jacobians[k].cols()) =
            jacobians[k].row(r).transpose();
      }
      solver.solve({row.data(), static_cast<std::size_t>(unknowns)},
                   {solved.data(), static_cast<std::size_t>(unknowns)});
      for (std::size_t k = 0; k < vertices.size(); ++k) {
        const int column = structure.column_of(vertices[k]);
        if (column < 0) continue;
        predicted.col(r) += jacobians[k] * solved.segment(pattern.start[static_cast<std::size_t>(column)],
                                                          jacobians[k].cols());
      }
    }
    // With Omega = A^T A: (Omega^-1 + C)^-1 = A^T (I + A C A^T)^-1 A also holds if Omega is singular.
    const Eigen::MatrixXd root = information_root(batch.information(edges[i].edge));
    result[i] = 0;
    if (root.rows() == 0) continue;
    const double sign = membership == Membership::outside ? 1 : -1;
    const auto [spread, directions] = symmetric_eigen(Eigen::MatrixXd::Identity(root.rows(), root.rows()) +
                                                      sign * root * predicted * root.transpose());
    // For an edge inside, directions that no other edge knows leave no spread, and rounding
    // would decide.
    const bool checked = membership == Membership::outside || spread[0] > 1e-9 * spread[root.rows() - 1];
    const Eigen::VectorXd along = directions.transpose() * (root * e);
    if (checked) result[i] = along.cwiseAbs2().cwiseQuotient(spread).sum();
  }
  return result;
}

namespace {

/// The parts of a graph that its edges join, and that further edges would join.
class Parts {
 public:
  explicit Parts(const Graph& graph)
      : graph_(graph),
        part_(detail::find_components(graph)),
        motions_(graph.vertex_count(), 0),
        joined_(graph.vertex_count()) {
    std::iota(joined_.begin(), joined_.end(), 0);
    const std::vector<char> held = find_gauge(graph, PartlyAnchored::hold_vertex).held;
    const std::vector<char> has_edge = vertices_with_edges(graph);
    for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
      if (graph.fixed(v)) continue;
      int& motions = motions_[at(part_[at(v)])];
      if (has_edge[at(v)] == 0)
        motions = graph.vertex_type(v).tangent_size;
      else if (is_wholly_held(held[at(v)]))
        motions = kOfPoses;
    }
  }

  /// Joins the parts of two vertices, if one of them may be moved so that an error becomes zero.
  /// @param dimension of the error
  bool join(std::span<const VertexIndex> vertices, int dimension) {
    if (vertices.size() != 2) return false;
    std::int32_t moved = part_of(vertices[0]);
    std::int32_t stays = part_of(vertices[1]);
    if (moved == stays) return false;
    if (motions_of(moved) == 0 || (motions_of(stays) > 0 && motions_of(stays) < motions_of(moved)))
      std::swap(moved, stays);
    if (motions_of(moved) == 0 || dimension < motions_of(moved)) return false;
    joined_[moved] = stays;
    return true;
  }

 private:
  static constexpr int kOfPoses = 3;
  static constexpr std::int32_t kFixed = -1;  // all fixed vertices

  static std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }
  [[nodiscard]] std::int32_t part_of(VertexIndex v) {
    std::int32_t part = graph_.fixed(v) ? kFixed : part_[at(v)];
    while (part != kFixed && joined_[at(part)] != part) {
      std::int32_t& next = joined_[at(part)];
      if (next != kFixed) next = joined_[at(next)];  // chains stay short
      part = next;
    }
    return part;
  }
  /// Returns how many motions of a part nothing stops; 0: it is anchored.
  [[nodiscard]] int motions_of(std::int32_t part) const { return part == kFixed ? 0 : motions_[at(part)]; }

  const Graph& graph_;
  std::vector<std::int32_t> part_;    // per vertex
  std::vector<int> motions_;          // per part
  std::vector<std::int32_t> joined_;  // per part: the one it belongs to, itself at first
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
