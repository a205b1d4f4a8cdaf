/// One edge whose sizes are known only at run time, linearised and weighed by its loss.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/graph/detail/robust_information.hpp>
#include <waymark/core/graph/edge_batch.hpp>

namespace waymark::detail {

struct WeighedEdge {
  Eigen::VectorXd error;
  std::vector<Eigen::MatrixXd> jacobians;  ///< one per vertex
  Eigen::MatrixXd omega;                   ///< the edge's own information
  double squared = 0;                      ///< e^T Omega e
  LossValue loss;                          ///< at `squared`; the squared error itself without a loss

  /// Returns the information between Jacobians in the Hessian.
  [[nodiscard]] Eigen::MatrixXd information() const {
    return robust_information(loss, squared, omega, error);
  }
  /// Returns what the transposed Jacobians carry into the gradient: rho' Omega e.
  [[nodiscard]] Eigen::VectorXd pull() const { return loss.weight * (omega * error); }
};

[[nodiscard]] inline WeighedEdge weigh(const EdgeBatchBase& batch, std::size_t edge, const ValueView& view) {
  WeighedEdge result;
  batch.linearize_edge(edge, view, result.error, result.jacobians);
  result.omega = batch.information(edge);
  result.squared = result.error.dot(result.omega * result.error);
  const Loss* loss = batch.loss(edge);
  result.loss = loss == nullptr ? LossValue{result.squared, 1, 0} : loss->at(result.squared);
  return result;
}

}  // namespace waymark::detail
