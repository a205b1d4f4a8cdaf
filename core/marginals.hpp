/// Marginal covariances at a minimum: diagonal blocks of H^-1, from a fresh undamped factor.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/graph.hpp>

namespace waymark {

/// The covariance of each vertex asked for, in the chart of its retraction (VERTEX_SE2: x, y in frame axes,
/// heading). Robust weights at the present values are in H, and the second-order terms of the losses where H
/// keeps them (robust_information.hpp): the Laplace approximation of the robust posterior. Vertices held for
/// the gauge, fixed ones and those without edges have covariance zero. Selected inversion (Takahashi): all
/// blocks on the pattern of the factor are found, so asking for all vertices costs as much as for one.
/// @throws InputError where H is not positive definite.
[[nodiscard]] std::vector<Eigen::MatrixXd> marginal_covariances(const Graph& graph,
                                                                std::span<const VertexIndex> vertices);

}  // namespace waymark
