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
  return squared_error(graph.batch(place.batch), place.edge, graph.view());
}

double squared_error(const EdgeBatchBase& batch, std::size_t edge, const ValueView& values) {
  Eigen::VectorXd e;
  std::vector<Eigen::MatrixXd> jacobians;
  batch.linearize_edge(edge, values, e, jacobians);
  return e.dot(batch.information(edge) * e);
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
    std::vector<std::int32_t> parts;
    for (const VertexIndex v : vertices) {
      const std::int32_t part = part_of(v);
      if (part < 0 || std::find(parts.begin(), parts.end(), part) != parts.end()) continue;
      parts.push_back(part);
      const Eigen::MatrixXd moved = moving_by(part, vertices, jacobians);
      result.conservativeResize(Eigen::NoChange, result.cols() + moved.cols());
      result.rightCols(moved.cols()) = moved;
    }
    return result;
  }

 private:
  /// Returns the part of a vertex; -1: it belongs to none.
  [[nodiscard]] std::int32_t part_of(VertexIndex v) const {
    const std::int32_t component = parts_.empty() ? -1 : components_.of[at(v)];
    return component < 0 ? -1 : part_[at(component)];
  }

  /// Returns the same for one part, all vertices of which move together; what cancels is 0.
  [[nodiscard]] Eigen::MatrixXd moving_by(std::int32_t part, std::span<const VertexIndex> vertices,
                                          std::span<const Eigen::MatrixXd> jacobians) const {
    constexpr double kRounding = 1e-6;
    const auto& [vertex, place, motions] = parts_[at(part)];
    Eigen::MatrixXd moved = Eigen::MatrixXd::Zero(jacobians[0].rows(), motions.cols());
    Eigen::MatrixXd terms = moved;
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      if (part_of(vertices[k]) != part) continue;
      const Eigen::MatrixXd motion = detail::motion_of(graph_, vertices[k], place);
      moved += jacobians[k] * motion * motions;
      terms += jacobians[k].cwiseAbs() * motion.cwiseAbs() * motions.cwiseAbs();
    }
    return (moved.array().abs() > kRounding * terms.array()).select(moved, 0);
  }

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

/// Compares an error with what the other edges predict.
/// @param root of the information @param predicted J P J^T @param open how motions that contradict nothing
/// move it
Innovation compare(const Eigen::VectorXd& e, const Eigen::MatrixXd& root, const Eigen::MatrixXd& predicted,
                   const Eigen::MatrixXd& open, Membership membership) {
  if (root.rows() == 0) return {0, 0};
  // With Omega = A^T A: (Omega^-1 + C)^-1 = A^T (I + A C A^T)^-1 A also holds if Omega is singular.
  const double sign = membership == Membership::outside ? 1 : -1;
  const auto [spread, directions] = symmetric_eigen(Eigen::MatrixXd::Identity(root.rows(), root.rows()) +
                                                    sign * root * predicted * root.transpose());
  Innovation result{0, 0.5 * spread.array().max(std::numeric_limits<double>::min()).log().sum()};
  // For an edge inside, directions that no other edge knows leave no spread, and rounding
  // would decide.
  if (membership == Membership::inside && !(spread[0] > 1e-9 * spread[root.rows() - 1])) return result;
  const Eigen::MatrixXd scaled =
      spread.cwiseSqrt().cwiseInverse().asDiagonal() * directions.transpose() * root;
  const Eigen::VectorXd along = scaled * e;
  const Eigen::MatrixXd free = spanned(scaled * open);
  if (free.cols() > 0) result.looseness = std::numeric_limits<double>::infinity();
  result.squared = (along - free * (free.transpose() * along)).squaredNorm();
  return result;
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
    const bool is_outside = membership == Membership::outside;
    const Eigen::MatrixXd open =
        is_outside ? unseen.moving(vertices, jacobians) : Eigen::MatrixXd(e.size(), 0);
    result[i] = compare(e, information_root(batch.information(edges[i].edge)), predicted, open, membership);
  }
  return result;
}

}  // namespace waymark
