#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include <Eigen/QR>

#include <waymark/core/base/detail/index.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/core/graph/detail/weighed_edge.hpp>
#include <waymark/core/graph/gaussian_prior.hpp>
#include <waymark/core/linear/dense_decompositions.hpp>
#include <waymark/core/linear/detail/information_root.hpp>
#include <waymark/core/system/detail/time_order.hpp>
#include <waymark/core/system/held_marks.hpp>
#include <waymark/core/window/marginalization.hpp>

namespace waymark {
namespace {

using detail::at;

/// |A x + b|^2 over the changes x of some vertices, as rows [A | b].
struct Factor {
  std::vector<VertexIndex> vertices;  // ascending
  Eigen::MatrixXd rows;
};

/// Marks the states of the prefix that stay: those without a stamp, which belong to no time, and those
/// that join a vertex with a place outside of the prefix. Removed, they would join all of these. So do
/// places without a stamp in a graph with stamps: landmarks, which would come back as others.
std::vector<char> states_in_use(const Graph& graph, VertexIndex count) {
  const auto has_place = [&](VertexIndex v) { return graph.vertex_type(v).position != nullptr; };
  bool has_stamps = false;
  for (VertexIndex v = 0; v < count && !has_stamps; ++v) has_stamps = graph.stamp(v).has_value();
  std::vector<char> in_use(at(count), 0);
  for (VertexIndex v = 0; v < count; ++v)
    in_use[at(v)] = has_stamps && !has_place(v) && !graph.stamp(v).has_value();
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    if (graph.edge_type(b).tag == GaussianPriorBatch::kTag) continue;  // joins what was dropped with all
    for_each_edge(graph.batch(b), [&](std::span<const VertexIndex> vertices) {
      const bool stays = std::any_of(vertices.begin(), vertices.end(),
                                     [&](VertexIndex v) { return v >= count && has_place(v); });
      if (!stays) return;
      for (const VertexIndex v : vertices)
        if (v < count && (!has_place(v) || (has_stamps && !graph.stamp(v)))) in_use[at(v)] = 1;
    });
  }
  return in_use;
}

/// Returns not zero for vertices of the prefix that are removed. The header says which ones stay.
std::vector<char> choose_gone(const Graph& graph, VertexIndex count) {
  const std::vector<char> in_use = states_in_use(graph, count);
  const auto in_prefix = [&](VertexIndex v) {
    return v < count && !graph.vertex_type(v).dense && in_use[at(v)] == 0;
  };
  std::vector<char> gone(graph.vertex_count(), 0);
  for (VertexIndex v = 0; v < count; ++v) gone[at(v)] = in_prefix(v);
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    for_each_edge(graph.batch(b), [&](std::span<const VertexIndex> vertices) {
      bool remains = true;   // none of its free vertices is removed
      bool outside = false;  // and an edge outside needs it
      for (const VertexIndex v : vertices) {
        remains = remains && (!in_prefix(v) || graph.fixed(v));
        outside = outside || !in_prefix(v);
      }
      if (!remains || !outside) return;
      for (const VertexIndex v : vertices) gone[at(v)] = 0;
    });
  }
  return gone;
}

/// Eliminates vertices from a sum of factors, one after the other, in the order of time. Each of them leaves
/// one factor
/// over its neighbours.
class Elimination {
 public:
  Elimination(const Graph& graph, VertexIndex count, std::span<const char> gone, std::span<const char> held)
      : graph_(graph), gone_(gone), held_(held), order_(detail::time_order(graph)), factors_of_(at(count)) {
    position_of_.assign(graph.vertex_count(), order_.size());
    for (std::size_t position = 0; position < order_.size(); ++position)
      position_of_[at(order_[position])] = position;
  }

  void add_edge(const EdgeBatchBase& batch, const EdgeType& type, std::size_t edge);
  /// Eliminates all vertices that are gone, in the order of time.
  void run() {
    for (const VertexIndex v : order_)
      if (gone_[at(v)] != 0) eliminate(v);
  }
  /// Returns the remaining factors, over vertices that stay.
  [[nodiscard]] const std::vector<Factor>& rest() const { return rest_; }
  [[nodiscard]] double constant() const { return constant_; }
  /// Returns the root of H_ii of the added edges, per tangent component of a vertex.
  [[nodiscard]] Eigen::VectorXd scale(VertexIndex v) const { return squares_.at(v).cwiseSqrt(); }

 private:
  void eliminate(VertexIndex v);
  void add(Factor factor);
  [[nodiscard]] int size_of(VertexIndex v) const { return graph_.vertex_type(v).tangent_size; }
  [[nodiscard]] Factor stack(VertexIndex first, std::span<const Factor> parts) const;
  void check_determined(VertexIndex v, const Eigen::MatrixXd& triangle) const;

  const Graph& graph_;
  std::span<const char> gone_;
  std::span<const char> held_;
  std::vector<VertexIndex> order_;
  std::vector<std::size_t> position_of_;
  // by the first vertex of the prefix that is eliminated
  std::vector<std::vector<Factor>> factors_of_;
  std::vector<Factor> rest_;
  std::map<VertexIndex, Eigen::VectorXd> squares_;
  double constant_ = 0;
};

void Elimination::add(Factor factor) {
  if (factor.vertices.empty()) {
    constant_ += factor.rows.squaredNorm();
    return;
  }
  VertexIndex first = -1;
  for (const VertexIndex v : factor.vertices)
    if (gone_[at(v)] != 0 && (first < 0 || position_of_[at(v)] < position_of_[at(first)])) first = v;
  if (first < 0) {
    rest_.push_back(std::move(factor));
  } else {
    factors_of_[at(first)].push_back(std::move(factor));
  }
}

void Elimination::add_edge(const EdgeBatchBase& batch, const EdgeType& type, std::size_t edge) {
  const detail::WeighedEdge weighed = detail::weigh(batch, edge, graph_.view());
  const std::vector<Eigen::MatrixXd>& jacobians = weighed.jacobians;
  const Eigen::MatrixXd root = information_root(weighed.information());
  // The root is that of w Omega, with its part along e multiplied by the factor. The gradient is
  // J^T w Omega e.
  const Eigen::VectorXd b = root * weighed.error / curvature_factor(weighed.loss, weighed.squared);

  const std::span<const VertexIndex> named = batch.vertices(edge);
  std::vector<std::size_t> order;
  Eigen::Index columns = 0;
  for (std::size_t k = 0; k < named.size(); ++k) {
    if (graph_.fixed(named[k]) || (!held_.empty() && is_wholly_held(held_[at(named[k])]))) continue;
    order.push_back(k);
    columns += jacobians[k].cols();
  }
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t c) { return named[a] < named[c]; });
  Factor factor;
  factor.rows.resize(root.rows(), columns + 1);
  Eigen::Index next = 0;
  for (const std::size_t k : order) {
    const Eigen::MatrixXd whitened = root * jacobians[k];
    factor.vertices.push_back(named[k]);
    factor.rows.middleCols(next, whitened.cols()) = whitened;
    next += whitened.cols();
    const auto place = squares_.try_emplace(named[k], Eigen::VectorXd::Zero(whitened.cols())).first;
    place->second += whitened.colwise().squaredNorm().transpose();
  }
  factor.rows.rightCols(1) = b;
  if (!factor.rows.allFinite()) {
    throw InputError(type.tag + " at vertex " + to_string(graph_.id(named.front())) +
                     ": error or derivative is not finite, so it cannot be marginalised");
  }
  constant_ += weighed.loss.rho - b.squaredNorm();
  add(std::move(factor));
}

/// Stacks all parts into one factor; the columns of `first` lead.
Factor Elimination::stack(VertexIndex first, std::span<const Factor> parts) const {
  Factor all;
  Eigen::Index height = 0;
  for (const Factor& part : parts) {
    all.vertices.insert(all.vertices.end(), part.vertices.begin(), part.vertices.end());
    height += part.rows.rows();
  }
  const auto before = [&](VertexIndex a, VertexIndex b) {
    return std::pair(a != first, a) < std::pair(b != first, b);
  };
  std::sort(all.vertices.begin(), all.vertices.end(), before);
  all.vertices.erase(std::unique(all.vertices.begin(), all.vertices.end()), all.vertices.end());
  std::map<VertexIndex, Eigen::Index> start;
  Eigen::Index width = 0;
  for (const VertexIndex v : all.vertices) {
    start[v] = width;
    width += size_of(v);
  }
  all.rows.setZero(height, width + 1);
  Eigen::Index row = 0;
  for (const Factor& part : parts) {
    const Eigen::Index rows = part.rows.rows();
    Eigen::Index column = 0;
    for (const VertexIndex v : part.vertices) {
      all.rows.block(row, start[v], rows, size_of(v)) = part.rows.middleCols(column, size_of(v));
      column += size_of(v);
    }
    all.rows.block(row, width, rows, 1) = part.rows.rightCols(1);
    row += rows;
  }
  return all;
}

/// Compares with the information of the edges about the vertex if everything else is known.
void Elimination::check_determined(VertexIndex v, const Eigen::MatrixXd& triangle) const {
  const Eigen::VectorXd scale = squares_.at(v).cwiseSqrt();
  bool determined = triangle.rows() == triangle.cols() && scale.minCoeff() > 0;
  if (determined) {
    const Eigen::MatrixXd relative = triangle * scale.cwiseInverse().asDiagonal();
    const Eigen::VectorXd values = singular_values(relative).values;
    determined = values.minCoeff() > std::sqrt(kInformationResolution);
  }
  if (determined) return;
  throw InputError("vertex " + to_string(graph_.id(v)) +
                   " cannot be marginalised: the edges that would be removed do not determine it, "
                   "and no edge joins it to a vertex that stays; add a prior or a fix, FIX a "
                   "vertex, or hold the vertices that find_gauge names");
}

// Eliminates v by QR of all rows that contain it. The rows with R_vv determine v, and vanish at the
// minimum over v. The rows below hold the information about its neighbours.
void Elimination::eliminate(VertexIndex v) {
  const std::vector<Factor> parts = std::exchange(factors_of_[at(v)], {});
  if (parts.empty()) return;
  Factor all = stack(v, parts);
  const int size = size_of(v);
  const Eigen::Index height = std::min(all.rows.rows(), all.rows.cols());
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(std::move(all.rows));
  const Eigen::MatrixXd triangle = qr.matrixQR().topRows(height).triangularView<Eigen::Upper>();
  const Eigen::Index top = std::min<Eigen::Index>(size, height);
  check_determined(v, triangle.topLeftCorner(top, size));
  Factor rest;
  rest.vertices.assign(all.vertices.begin() + 1, all.vertices.end());
  rest.rows = triangle.bottomRightCorner(height - size, triangle.cols() - size);
  add(std::move(rest));
}

/// The factor as a prior: information Lambda, and offset d. A d = -b holds for the part of b in
/// the range of A.
struct Prior {
  Eigen::MatrixXd information;
  Eigen::VectorXd offset;
  double constant = 0;  ///< squared length of the part of b outside
};

Prior to_prior(const Factor& factor, const Elimination& elimination) {
  const Eigen::Index n = factor.rows.cols() - 1;
  Eigen::VectorXd scale(n);
  Eigen::Index next = 0;
  for (const VertexIndex v : factor.vertices) {
    const Eigen::VectorXd part = elimination.scale(v);
    scale.segment(next, part.size()) = part;
    next += part.size();
  }
  Prior prior;
  if (factor.rows.rows() == 0) {
    prior.information.setZero(n, n);
    return prior;
  }
  const Eigen::VectorXd inverse = (scale.array() > 0).select(scale.cwiseInverse(), 0);
  const auto [values, left, right] = singular_values(factor.rows.leftCols(n) * inverse.asDiagonal());
  Eigen::Index rank = 0;
  while (rank < values.size() && values[rank] > std::sqrt(kInformationResolution)) ++rank;
  const Eigen::VectorXd b = factor.rows.rightCols(1);
  const Eigen::VectorXd inside = left.leftCols(rank).transpose() * b;
  const Eigen::MatrixXd directions = right.leftCols(rank);
  const Eigen::MatrixXd root = values.head(rank).asDiagonal() * directions.transpose() * scale.asDiagonal();
  prior.information = root.transpose() * root;
  prior.information = (0.5 * (prior.information + prior.information.transpose())).eval();
  prior.offset = -(inverse.asDiagonal() * directions * inside.cwiseQuotient(values.head(rank)));
  prior.constant = b.squaredNorm() - inside.squaredNorm();
  return prior;
}

void check(const Graph& graph, VertexIndex count, std::span<const char> held) {
  if (count < 0 || at(count) > graph.vertex_count()) {
    throw UsageError("marginalize_prefix: " + std::to_string(count) + " vertices of " +
                     std::to_string(graph.vertex_count()));
  }
  if (!held.empty() && held.size() != graph.vertex_count()) {
    throw UsageError("marginalize_prefix: one mark per vertex is needed in `held`");
  }
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    if (graph.edge_type(b).tag == GaussianPriorBatch::kTag && graph.batch(b).batch_loss() != nullptr) {
      throw UsageError(
          "marginalize_prefix: the batch EDGE_GAUSSIAN_PRIOR has a loss, which would change the new "
          "prior; give the loss to single edges");
    }
  }
}

}  // namespace

Marginalization marginalize_prefix(Graph& graph, VertexIndex count, std::span<const char> held) {
  check(graph, count, held);
  const std::vector<char> gone = choose_gone(graph, count);
  Elimination elimination(graph, count, gone, held);
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    std::size_t edge = 0;
    for_each_edge(graph.batch(b), [&](std::span<const VertexIndex> vertices) {
      const bool goes =
          std::any_of(vertices.begin(), vertices.end(), [&](VertexIndex v) { return gone[at(v)] != 0; });
      if (goes) elimination.add_edge(graph.batch(b), graph.edge_type(b), edge);
      ++edge;
    });
  }
  elimination.run();

  Marginalization result;
  result.constant = elimination.constant();
  result.removal = graph.remove_vertices(gone);
  for (const Factor& factor : elimination.rest()) {
    const Prior prior = to_prior(factor, elimination);
    result.constant += prior.constant;
    if (prior.information.isZero(0)) continue;  // there is no information about them
    std::vector<VertexIndex> vertices;
    std::vector<double> fields;
    for (const VertexIndex old : factor.vertices) {
      vertices.push_back(result.removal.new_index[at(old)]);
      const std::span<const double> reference = graph.value(vertices.back());
      fields.insert(fields.end(), reference.begin(), reference.end());
    }
    fields.insert(fields.end(), prior.offset.begin(), prior.offset.end());
    graph.add_edge(gaussian_prior_type(), vertices, fields, prior.information);
    ++result.priors;
  }
  return result;
}

}  // namespace waymark
