/// The normal equations H d = -g of a graph at its present values: H = sum w J^T Omega J, g = sum w J^T Omega
/// e. chi2 = sum rho(e^T Omega e) is not halved, so its gradient is 2 g and its Gauss-Newton Hessian 2 H.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/base/detail/large_array.hpp>
#include <waymark/core/base/detail/thread_pool.hpp>
#include <waymark/core/graph/graph.hpp>
#include <waymark/core/system/structure.hpp>

namespace waymark {

class NormalEquations {
 public:
  /// Both must outlive this object; the structure must have been built for the graph.
  NormalEquations(const Graph& graph, const Structure& structure);

  /// Threads to work with from now on, null: the caller's alone. The bits of H, g and chi2 do not depend on
  /// it.
  void set_threads(ThreadPool* pool) { pool_ = pool; }

  /// Fills H and g at `values` (laid out as graph.values()) and returns chi2 there.
  /// @param evidence_weights  empty, or for each batch NormalView::evidence_weight
  double linearize(const std::vector<double>& values, std::span<const double> evidence_weights = {});
  /// chi2 at other values; H and g stay.
  [[nodiscard]] double chi2(const std::vector<double>& values) const;

  [[nodiscard]] const BlockPattern& pattern() const { return structure_.pattern(); }
  /// Numbers of H, laid out as pattern() says.
  [[nodiscard]] std::span<const double> hessian() const {
    return {hessian_.data(), static_cast<std::size_t>(pattern().value_count())};
  }
  [[nodiscard]] Eigen::Map<const Eigen::VectorXd> gradient() const {
    return {gradient_.data(), pattern().dimension()};
  }
  /// Diagonal of H, in elimination order like all vectors here; gathered once for each linearisation.
  [[nodiscard]] const Eigen::VectorXd& diagonal() const;
  /// H + diag(extra), into `damped` (same layout as hessian()).
  void add_to_diagonal(const Eigen::VectorXd& extra, std::vector<double>& damped) const;
  /// H x, into `product`.
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& product) const;
  /// values [+] step, into `moved`: empty, or earlier filled by this function.
  void retract(const std::vector<double>& values, const Eigen::VectorXd& step,
               std::vector<double>& moved) const;
  /// The vertex that a scalar unknown belongs to.
  [[nodiscard]] VertexIndex vertex_of_unknown(std::int64_t unknown) const;

 private:
  /// Calls work(batch, range) for all edges, chunks side by side, the last one after the others, and
  /// sums what it returns in order.
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
