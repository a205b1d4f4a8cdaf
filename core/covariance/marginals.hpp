/// Marginal covariances at a minimum: blocks of H^-1, from a fresh undamped factor.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/base/detail/large_array.hpp>
#include <waymark/core/graph/graph.hpp>
#include <waymark/core/linear/block_cholesky.hpp>
#include <waymark/core/system/gauge.hpp>
#include <waymark/core/system/structure.hpp>

namespace waymark {

/// Square matrices of any sizes in one array.
class CovarianceBlocks {
 public:
  [[nodiscard]] std::size_t size() const { return places_.size(); }
  [[nodiscard]] Eigen::Map<const Eigen::MatrixXd> operator[](std::size_t i) const& {
    return {numbers_.data() + places_[i].begin, places_[i].size, places_[i].size};
  }
  /// Of a temporary: a copy, as a view would outlive the numbers.
  [[nodiscard]] Eigen::MatrixXd operator[](std::size_t i) && { return std::as_const(*this)[i]; }

 private:
  friend class Marginals;
  struct Place {
    std::int64_t begin = 0;
    int size = 0;
  };
  std::vector<Place> places_;
  LargeArray<double> numbers_;
};

/// The Gaussian that a graph's normal equations stand for: N(present values, H^-1).
///
/// Covariances are in the chart of each vertex's retraction (VERTEX_SE2: x, y in frame axes, heading), in the
/// units of its tangent. Robust weights at the present values are in H, and the second-order terms of the
/// losses where H keeps them (robust_information.hpp): the Laplace approximation of the robust posterior.
/// Where nothing anchors a component (gauge.hpp), its first vertex is held, and covariances are relative to
/// it. Vertices that are held, fixed or without edges have covariance zero with everything; so have, exactly,
/// vertices of different components, and coordinates that no edge couples.
class Marginals {
 public:
  /// Linearises and factorises at the present values. The graph must outlive this object and keep them.
  /// @throws InputError where H is not positive definite, or as find_gauge does.
  explicit Marginals(const Graph& graph);

  /// The covariance of each vertex asked for, by selected inversion: all of them cost as much as a few
  /// factorisations.
  [[nodiscard]] CovarianceBlocks blocks(std::span<const VertexIndex> vertices) const;

  /// The joint covariance of these vertices, adjacent or not: their tangents one after the other, in the
  /// order given. One solve with the factor for each column.
  [[nodiscard]] Eigen::MatrixXd joint(std::span<const VertexIndex> vertices);

  /// What was held, and what is to be told of it.
  [[nodiscard]] const Gauge& gauge() const { return gauge_; }
  /// Whether a vertex is estimated: not held, not fixed, not without edges.
  [[nodiscard]] bool estimated(VertexIndex v) const { return structure_.column_of(v) >= 0; }

 private:
  const Graph& graph_;
  Gauge gauge_;
  Structure structure_;
  BlockCholesky cholesky_;
};

/// Marginals(graph).blocks(vertices).
[[nodiscard]] CovarianceBlocks marginal_covariances(const Graph& graph,
                                                    std::span<const VertexIndex> vertices);

}  // namespace waymark
