/// Marginal covariances at a minimum: blocks of H^-1 from a fresh undamped factor.
///
/// Marginals refers to the graph, which must outlive it; its values and edges must not change
/// meanwhile. The returned blocks belong to the caller. Threads: several may ask one object at the
/// same time. Preconditions: vertices are indices of this graph. The values are a minimum, because
/// covariances mean nothing elsewhere.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/base/detail/large_array.hpp>
#include <waymark/core/base/export.hpp>
#include <waymark/core/graph/graph.hpp>
#include <waymark/core/linear/block_cholesky.hpp>
#include <waymark/core/system/gauge.hpp>
#include <waymark/core/system/structure.hpp>

namespace WAYMARK_EXPORT waymark {

/// Square matrices of any sizes, stored in one array.
class CovarianceBlocks {
 public:
  [[nodiscard]] std::size_t size() const { return places_.size(); }
  [[nodiscard]] Eigen::Map<const Eigen::MatrixXd> operator[](std::size_t i) const& {
    return {numbers_.data() + places_[i].begin, places_[i].size, places_[i].size};
  }
  /// A temporary returns a copy, because a view would outlive the numbers.
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

/// The Gaussian of a graph's normal equations: N(present values, H^-1).
///
/// Covariances are in the chart of each vertex's retraction (VERTEX_SE2: x, y in frame axes,
/// heading), in the units of its tangent. H contains the robust weights at the present values, and
/// the second-order terms of the losses if H keeps them (robust_information.hpp). This is the
/// Laplace approximation of the robust posterior.
///
/// If nothing anchors a component (gauge.hpp), its first vertex is held, and covariances are
/// relative to it. A vertex that is held, fixed or without edges has covariance zero with
/// everything. The covariance is also exactly zero between vertices of different components, and
/// between coordinates that no edge couples.
class Marginals {
 public:
  /// Linearises and factorises at the present values. The graph must outlive this object, and its
  /// values must not change.
  /// @throws InputError if H is not positive definite, or as find_gauge does
  explicit Marginals(const Graph& graph);

  /// Returns the covariance of each requested vertex by selected inversion. All vertices together
  /// cost as much as a few factorisations.
  [[nodiscard]] CovarianceBlocks blocks(std::span<const VertexIndex> vertices) const;

  /// Returns the joint covariance of these vertices, adjacent or not. Their tangents are in the
  /// given order. Each column costs a substitution along the ways from the vertices to the root of the
  /// elimination tree.
  [[nodiscard]] Eigen::MatrixXd joint(std::span<const VertexIndex> vertices) const;

  /// Returns what was held, and the messages about it.
  [[nodiscard]] const Gauge& gauge() const { return gauge_; }
  /// Tells whether a vertex is estimated: it is not held, not fixed, and has edges.
  [[nodiscard]] bool estimated(VertexIndex v) const { return structure_.column_of(v) >= 0; }

 private:
  const Graph& graph_;
  Gauge gauge_;
  Structure structure_;
  BlockCholesky cholesky_;
};

/// Returns Marginals(graph).blocks(vertices).
[[nodiscard]] CovarianceBlocks marginal_covariances(const Graph& graph,
                                                    std::span<const VertexIndex> vertices);

}  // namespace waymark
