/// The normal equations H d = -g of a graph at its present values: H = sum w J^T Omega J, g = sum w J^T Omega
/// e. chi2 = sum rho(e^T Omega e) is not halved, so its gradient is 2 g and its Gauss-Newton Hessian 2 H.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/graph.hpp>
#include <waymark/core/structure.hpp>

namespace waymark {

class NormalEquations {
 public:
  /// Both must outlive this object; the structure must have been built for the graph.
  NormalEquations(const Graph& graph, const Structure& structure);

  /// Fills H and g at `values` (laid out as graph.values()) and returns chi2 there.
  double linearize(const std::vector<double>& values);
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
  /// Diagonal of H, in elimination order like all vectors here.
  [[nodiscard]] Eigen::VectorXd diagonal() const;
  /// H + diag(extra), into `damped` (same layout as hessian()).
  void add_to_diagonal(const Eigen::VectorXd& extra, std::vector<double>& damped) const;
  /// H x.
  [[nodiscard]] Eigen::VectorXd multiply(const Eigen::VectorXd& x) const;
  /// values [+] step, into `moved`.
  void retract(const std::vector<double>& values, const Eigen::VectorXd& step,
               std::vector<double>& moved) const;
  /// The vertex that a scalar unknown belongs to.
  [[nodiscard]] VertexIndex vertex_of_unknown(std::int64_t unknown) const;

 private:
  const Graph& graph_;
  const Structure& structure_;
  std::vector<double> hessian_;
  std::vector<double> gradient_;
};

}  // namespace waymark
