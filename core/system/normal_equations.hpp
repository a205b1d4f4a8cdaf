/// The normal equations H d = -g of a graph at its present values: H = sum w J^T Omega J, g = sum w
/// J^T Omega e. chi2 = sum rho(e^T Omega e) is not halved. So its gradient is 2 g, and its
/// Gauss-Newton Hessian is 2 H.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/base/detail/large_array.hpp>
#include <waymark/core/base/detail/thread_pool.hpp>
#include <waymark/core/base/export.hpp>
#include <waymark/core/graph/graph.hpp>
#include <waymark/core/system/structure.hpp>

namespace WAYMARK_EXPORT waymark {

/// Returned spans and references are valid until the next linearize(). One thread at a
/// time may use it.
class NormalEquations {
 public:
  /// Both must outlive this object. The structure must have been built for the graph.
  NormalEquations(const Graph& graph, const Structure& structure);

  /// Sets the threads for all later calls; null: only the caller's. The bits of H, g and chi2 do
  /// not depend on it.
  void set_threads(ThreadPool* pool) { pool_ = pool; }

  /// Computes H and g at `values` (in the layout of graph.values()), and returns chi2 there. A coordinate
  /// that the structure holds gets 1e12 times the information that it has. It then keeps its value, up to
  /// rounding, if the edges do not see the motion that it stands for (gauge.hpp).
  /// @param evidence_weights empty, or NormalView::evidence_weight for each batch
  double linearize(const std::vector<double>& values, std::span<const double> evidence_weights = {});
  /// Computes the same with the whole second-order terms of the losses of edges with fixed arity,
  /// also where these are concave (robust_information.hpp leaves them out there). Near a minimum
  /// Newton's steps then converge quadratically. Far from one H may not be positive definite.
  double linearize_with_concave_terms(const std::vector<double>& values);
  /// Returns chi2 at other values. H and g do not change.
  [[nodiscard]] double chi2(const std::vector<double>& values) const;

  [[nodiscard]] const BlockPattern& pattern() const { return structure_.pattern(); }
  /// Returns the numbers of H in the layout of pattern().
  [[nodiscard]] std::span<const double> hessian() const {
    return {hessian_.data(), static_cast<std::size_t>(pattern().value_count())};
  }
  [[nodiscard]] Eigen::Map<const Eigen::VectorXd> gradient() const {
    return {gradient_.data(), pattern().dimension()};
  }
  /// Returns the diagonal of H in elimination order, like all vectors here. It is collected once
  /// per linearisation.
  [[nodiscard]] const Eigen::VectorXd& diagonal() const;
  /// Returns the sum of log H_cc over the coordinates that the structure holds. Without it the determinant of
  /// H is that of the other unknowns.
  [[nodiscard]] double log_of_held_information() const;
  /// Computes H + diag(extra) into `damped` (in the layout of hessian()).
  void add_to_diagonal(const Eigen::VectorXd& extra, std::vector<double>& damped) const;
  /// Computes H x into `product`.
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& product) const;
  /// Computes values [+] step into `moved`, which is empty or was filled by this function before.
  void retract(const std::vector<double>& values, const Eigen::VectorXd& step,
               std::vector<double>& moved) const;
  /// Returns the vertex of a scalar unknown.
  [[nodiscard]] VertexIndex vertex_of_unknown(std::int64_t unknown) const;

 private:
  double linearize_edges(const ValueView& view, std::span<const double> evidence_weights);
  [[nodiscard]] std::size_t place_of(const HeldCoordinate& held) const;
  void hold_coordinates();
  void add_concave_terms(std::size_t batch, const ValueView& view);
  /// Calls work(batch, range) for all edges: the chunks in parallel, then the last one. It sums the
  /// results in order.
  template <typename Work>
  double sum_over_chunks(const Work& work) const;

  const Graph& graph_;
  const Structure& structure_;
  ThreadPool* pool_ = nullptr;
  LargeArray<double> hessian_;
  LargeArray<double> gradient_;
  mutable std::vector<double> sums_;  // per chunk
  mutable Eigen::VectorXd diagonal_;
  mutable bool diagonal_known_ = false;
};

}  // namespace waymark
