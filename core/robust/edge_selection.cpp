#include <algorithm>
#include <limits>

#include <waymark/core/base/detail/index.hpp>
#include <waymark/core/linear/dense_decompositions.hpp>
#include <waymark/core/linear/detail/information_root.hpp>
#include <waymark/core/linear/inverse_form.hpp>
#include <waymark/core/robust/edge_selection.hpp>
#include <waymark/core/system/detail/components.hpp>
#include <waymark/core/system/gauge.hpp>
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

namespace {

using detail::at;

/// The motions that no edge sees of parts that are anchored in part.
class UnseenMotions {
 public:
  UnseenMotions(const Graph& graph, const std::vector<PartlyFree>& parts) : graph_(graph), parts_(parts) {
    if (parts.empty()) return;
    components_ = detail::describe_components(graph);
    part_.assign(components_.first.size(), -1);
    for (std::size_t p = 0; p < parts.size(); ++p)
      part_[at(components_.of[at(parts[p].vertex)])] = static_cast<std::int32_t>(p);
  }

  /// Returns how they move an error: one column each, none if they do not.
  [[nodiscard]] Eigen::MatrixXd moving(std::span<const VertexIndex> vertices,
                                       std::span<const Eigen::MatrixXd> jacobians) const {
    Eigen::MatrixXd result(jacobians[0].rows(), 0);
    if (parts_.empty()) return result;
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      const std::int32_t component = components_.of[at(vertices[k])];
      const std::int32_t p = component < 0 ? -1 : part_[at(component)];
      if (p < 0) continue;
      const PartlyFree& part = parts_[at(p)];
      const Eigen::Index before = result.cols();
      result.conservativeResize(Eigen::NoChange, before + part.motions.cols());
      result.rightCols(part.motions.cols()) =
          jacobians[k] * detail::motion_of(graph_, vertices[k], part.place) * part.motions;
    }
    return result;
  }

 private:
  const Graph& graph_;
  const std::vector<PartlyFree>& parts_;
  detail::Components components_;
  std::vector<std::int32_t> part_;  // per component; -1: it is no such part
};

/// Returns the directions that the columns of a matrix span, as orthonormal columns.
Eigen::MatrixXd spanned(const Eigen::MatrixXd& matrix) {
  constexpr double kRounding = 1e-6;
  if (matrix.cols() == 0) return matrix;
  const SingularValues svd = singular_values(matrix);
  return svd.left.leftCols((svd.values.array() > kRounding * svd.values[0]).count());
}

}  // namespace

std::vector<Innovation> innovations(const Graph& graph, std::span<const EdgePlace> edges,
                                    Membership membership, const Graph& kept) {
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  std::vector<Innovation> result(edges.size(), {kUnknown, kUnknown});
  if (edges.empty()) return result;
  Structure structure;
  const Gauge gauge = find_gauge(kept);
  structure.build(kept, gauge.held);
  NormalEquations equations(kept, structure);
  (void)equations.linearize(kept.values());
  BlockCholesky cholesky;
  cholesky.analyze(structure.pattern());
  if (cholesky.factorize(equations.hessian()) != FactorStatus::ok) return result;
  InverseForm form(cholesky);
  const UnseenMotions unseen(kept, gauge.partly);
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
    const Eigen::VectorXd scale = spread.cwiseSqrt().cwiseInverse();
    Eigen::VectorXd along = scale.asDiagonal() * (directions.transpose() * (root * e));
    result[i].looseness = 0.5 * spread.array().max(std::numeric_limits<double>::min()).log().sum();
    if (membership == Membership::outside) {
      // What parts that are anchored in part are free to do contradicts nothing.
      const Eigen::MatrixXd open =
          spanned(scale.asDiagonal() * directions.transpose() * root * unseen.moving(vertices, jacobians));
      along -= open * (open.transpose() * along);
      if (open.cols() > 0) result[i].looseness = kUnknown;
    }
    if (checked) result[i].squared = along.squaredNorm();
  }
  return result;
}

}  // namespace waymark
