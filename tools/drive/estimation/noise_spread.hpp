/// What a drive leaves open of its noise, as a part of the covariances of its poses.
///
/// The inverse of H is the covariance of a pose x at the estimated noise. A short drive knows its noise
/// poorly: ten minutes hold ten errors that last for a minute. Whatever the noise is, the covariance is
///   E[C(noise)] + Cov[x(noise)]
/// over the posterior of the noise (law of total covariance). It is integrated by Gauss and Hermite's rule
/// with three points along each principal axis of that posterior, as approximate Bayesian inference does for
/// parameters of this kind (Rue, Martino, Chopin, "Approximate Bayesian inference for latent Gaussian
/// models", J. R. Statist. Soc. B 71, 2009, section 6.5), on the coarse drive of the search.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/tools/drive/estimation/noise.hpp>
#include <waymark/tools/drive/estimation/noise_objective.hpp>

namespace waymark::drive {

/// Returns what is added to the covariances of the nodes, in order of time. Empty if the covariances are not
/// defined. @param noise the estimate @param covariance of its coordinates, n x n
[[nodiscard]] std::vector<PoseSpread> spread_over_noise(NoiseObjective& objective, const NoiseEstimate& noise,
                                                        const Eigen::MatrixXd& covariance);

/// Adds the spread at the time of each to covariances of poses, linearly between two times. Vertices without a
/// stamp or of another dimension than a pose keep theirs. @param spread in order of time; empty: nothing changes
void widen(std::vector<formats::VertexCovariance>& covariances, const Graph& graph,
           std::span<const PoseSpread> spread);

}  // namespace waymark::drive
