/// Edges whose sizes are known only at run time: one step of the linearisation.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/graph/detail/robust_information.hpp>
#include <waymark/core/graph/edge_batch.hpp>

namespace waymark::detail {

/// Adds one edge to the normal equations. @return rho of its squared error
/// @param jacobians one per vertex
/// @param loss at e^T Omega e
/// @param gradient, block its places in the scatter
inline double add_dense_edge(const Eigen::VectorXd& error, const std::vector<Eigen::MatrixXd>& jacobians,
                             const Eigen::MatrixXd& information, const LossValue& loss,
                             const std::uint32_t* gradient, const BlockTarget* block,
                             const NormalView& normal) {
  const double squared = error.dot(information * error);
  const Eigen::MatrixXd weighted = normal.evidence_weight > 0
                                       ? std::min(loss.weight, normal.evidence_weight) * information
                                       : robust_information(loss, squared, information, error);
  const Eigen::VectorXd weighted_error = loss.weight * (information * error);
  for (std::size_t k = 0; k < jacobians.size(); ++k) {
    const Eigen::MatrixXd left = jacobians[k].transpose() * weighted;
    Eigen::Map<Eigen::VectorXd>(normal.gradient + *gradient++, left.rows()) +=
        jacobians[k].transpose() * weighted_error;
    for (std::size_t l = 0; l <= k; ++l, ++block) {
      const Eigen::MatrixXd product = left * jacobians[l];
      const Eigen::MatrixXd& placed = block->stride < 0 ? Eigen::MatrixXd(product.transpose()) : product;
      Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>>(
          normal.hessian + block->offset, placed.rows(), placed.cols(),
          Eigen::OuterStride<>(std::abs(block->stride))) += placed;
    }
  }
  return loss.rho;
}

}  // namespace waymark::detail
