/// The marginal likelihood of a graph's measurements: how well noise parameters explain a drive.
///
/// With the unknowns x integrated out by Laplace's method at the minimum (MacKay, "Bayesian Interpolation",
/// Neural Computation 4, 1992),
///   -log p(z | noise) = 1/2 chi2 + 1/2 log det H - 1/2 sum_e log det Omega_e + const.
/// The first term falls as the noise grows, the last rises, and log det H charges for the unknowns that fit
/// the measurements. H is not that of the steps. For an edge with a robust loss it takes
/// min(w, m) Omega: w is the weight of iteratively reweighted least squares, and m that at which a normal
/// distribution has the mass of exp(-rho / 2) (2/3 for the Cauchy loss that makes Student's t of four degrees
/// of freedom in the plane). With w alone, which is 1 at the peak, every error that other unknowns take up
/// would seem 1/m too improbable, and noise with heavy tails be found where there is none; the second-order
/// terms, kept for some edges and not for others, would make it jump. The constant takes in whatever depends
/// only on the number and kind of edges: the powers of 2 pi and, under a loss of fixed scale, its normaliser.
#pragma once

#include <waymark/core/graph/graph.hpp>
#include <waymark/core/linear/block_cholesky.hpp>
#include <waymark/core/system/structure.hpp>

namespace waymark {

/// The terms at a graph's present values, which should be its minimum.
struct Evidence {
  double chi2 = 0;
  double log_det_hessian = 0;
  double log_det_information = 0;  ///< sum over all edges, of the part of Omega that is not zero
  /// What the noise minimises. Infinite where H is not positive definite.
  [[nodiscard]] double negative_log() const { return 0.5 * (chi2 + log_det_hessian - log_det_information); }
};

/// @param structure  follows the graph, whose gauge whoever built it has looked at
/// @param cholesky   has analysed the structure's pattern; is left with the factor of H
[[nodiscard]] Evidence evidence(const Graph& graph, const Structure& structure, BlockCholesky& cholesky);

/// The same, with both made for it. Where nothing anchors the graph, what is held (gauge.hpp) does not matter
/// for comparisons under one structure. @throws InputError as find_gauge does
[[nodiscard]] Evidence evidence(const Graph& graph);

}  // namespace waymark
