/// The marginal likelihood of a graph's measurements. It tells how well noise parameters
/// explain a drive.
///
/// Laplace's method at the minimum integrates out the unknowns x (MacKay, "Bayesian Interpolation",
/// Neural Computation 4, 1992):
///   -log p(z | noise) = 1/2 chi2 + 1/2 log det H - 1/2 sum_e log det Omega_e + const.
/// The first term falls if the noise grows, and the last one rises. log det H charges for the
/// unknowns that fit the measurements. The constant contains everything that depends only on the
/// number and kind of edges: the powers of 2 pi and, for a loss of fixed scale, its normaliser.
///
/// This H differs from the H of optimisation steps. An edge with a robust loss adds min(w, m) Omega
/// to it. w is the weight of iteratively reweighted least squares. m is the weight at which a
/// normal distribution has the mass of exp(-rho / 2). It is 2/3 for the Cauchy loss that makes
/// Student's t with four degrees of freedom in the plane. With w alone, which is 1 at the peak,
/// every error that other unknowns absorb would seem too improbable by the factor 1/m, and the
/// search would find heavy-tailed noise that is not there. Second-order terms are left out, because
/// some edges keep them and others do not, so the result would jump.
///
/// The functions keep nothing after a call. Other threads may read the graph meanwhile.
#pragma once

#include <vector>

#include <waymark/core/base/export.hpp>
#include <waymark/core/graph/graph.hpp>
#include <waymark/core/linear/block_cholesky.hpp>
#include <waymark/core/system/normal_equations.hpp>
#include <waymark/core/system/structure.hpp>

namespace WAYMARK_EXPORT waymark {

/// The terms at the present values of a graph, which should be its minimum.
struct Evidence {
  double chi2 = 0;
  double log_det_hessian = 0;
  double log_det_information = 0;  ///< sum over all edges, for the part of Omega that is not zero
  /// Returns the quantity that the best noise minimises. It is infinite if H is not
  /// positive definite.
  [[nodiscard]] double negative_log() const { return 0.5 * (chi2 + log_det_hessian - log_det_information); }
};

/// @param structure follows the graph; its builder has checked the gauge
/// @param cholesky has analysed the pattern of the structure (StructuredSolver::analysed); it keeps
/// the factor of H
[[nodiscard]] Evidence evidence(const Graph& graph, const Structure& structure, BlockCholesky& cholesky);

/// The evidence of a graph whose numbers change while its structure stays, as in a search for noise. It
/// keeps memory, factor and the weights of losses between the calls. One thread at a time may use it.
class RepeatedEvidence {
 public:
  /// Both must outlive this object, and the structure must follow the graph at every call.
  RepeatedEvidence(const Graph& graph, const Structure& structure);

  /// Returns the evidence of the graph at these values (in the layout of graph.values()).
  [[nodiscard]] Evidence at(const std::vector<double>& values);
  /// Returns half the gradient of chi2 at the values of the last call.
  [[nodiscard]] Eigen::Map<const Eigen::VectorXd> gradient() const { return equations_.gradient(); }

 private:
  /// The weight of a loss on errors of a dimension.
  struct LossWeight {
    Loss loss;
    int dimension = 0;
    double weight = 1;
  };
  [[nodiscard]] double weight_of(const Loss& loss, int dimension);
  [[nodiscard]] std::vector<double> weights();

  const Graph& graph_;
  NormalEquations equations_;
  BlockCholesky cholesky_;
  std::vector<LossWeight> known_;
};

/// Computes the same and makes structure and factor itself. If nothing anchors the graph,
/// find_gauge holds a vertex (gauge.hpp); this does not matter for comparisons under one structure.
/// @throws InputError as find_gauge does
[[nodiscard]] Evidence evidence(const Graph& graph);

}  // namespace waymark
