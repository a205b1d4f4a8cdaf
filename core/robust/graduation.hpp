/// Graduated non-convexity: optimisation that finds the outliers among the edges.
///
/// The method is that of Yang, Antonante, Tzoumas, Carlone, "Graduated Non-Convexity for Robust
/// Spatial Perception", RA-L 2020, with any loss. The loss of the candidates is m rho(s / m). The
/// first stretch m is so large that the loss is convex up to the largest error of the initial
/// guess. Every round divides m by a factor and takes a few steps, until m = 1. For Geman-McClure
/// this is the paper's schedule of mu.
///
/// The loss narrows to *less* than the noise of a good edge. If there are several groups of edges
/// that agree among themselves, the group that fits best then wins, and not one that bends the
/// graph just inside the gate. The verdict does not use a loss. Over splits of the candidates into
/// kept edges and outliers it minimises
///   cost = chi2 at the minimum of the kept edges + price of the outliers.
/// An edge costs its chi-square quantile (truncated least squares), a trusted one twice as much.
/// Consecutive edges that agree with each other are one mistake, and cost little more than one of them
/// (detail/wrong_places.hpp). A first split is grown, or follows from the errors of the edges. Then
/// the cost is lowered edge by edge: an outlier returns if its innovation (edge_selection.hpp) is
/// within the quantile, and a kept edge beyond it goes. The best width depends on how accurate the stated
/// noise is. So there are verdicts at stretch 16, 4 and 1 of the last width, and the one with the
/// lowest cost counts.
///
/// Trust is no certainty. Trusted edges that contradict each other between the same two places are
/// candidates from the beginning. So are those that the best split contradicts (their error is beyond
/// the quantile, widened if the errors of the trusted edges are larger than stated as a whole), if it
/// becomes cheaper without them. A wrong edge whose error a long way shares has no large error itself. If
/// chi2 is larger than noise makes it, or closures are outside, the trusted edges are therefore asked by how much
/// the minimum would fall without them, and asked again with those outliers inside that agree on one motion.
///
/// The first split has those candidates inside that another one close by confirms: at most two poses away at either
/// end, and as the odometry between them wants it. A place that is seen again is seen from several poses, but
/// single false closures confirm nothing, however many they are.
///
/// Few right closures, far from each other, confirm none of their neighbours. If a split keeps more candidates that
/// nothing close by confirms than others, the largest sets of candidates that are consistent pair by pair
/// (detail/consistent_edges.hpp) are judged too; not where their minima would take long.
///
/// Where that does not end well, or more than a twentieth of its outliers confirm each other too (a wrong group inside
/// may have put them out), a split is grown from the trusted edges: those candidates return that agree with the rest,
/// a few at a time, and first those whose place the rest knows best. That takes a small part of the time of
/// narrowing, because false edges do not fill the factor. The loss is narrowed if the kept edges do not fit, or if some
/// outliers agree on one motion, and more than may by chance: they may be right. It is not narrowed where a step with
/// all edges would take many seconds. If more than a fifth of the candidates are then outside and agree so, narrowing
/// is repeated from the minimum of the trusted edges, and at last without any trust: a wrong edge that alone joins two
/// parts contradicts nothing, once all right ones between them are out. The cheapest split of all searches
/// counts.
///
/// Ownership and threads are those of optimize(). The calling thread calls the trust rule.
#pragma once

#include <vector>

#include <waymark/core/base/export.hpp>
#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/core/robust/edge_selection.hpp>
#include <waymark/core/robust/joining_edges.hpp>
#include <waymark/core/robust/odometry_edges.hpp>
#include <waymark/core/robust/trust.hpp>

namespace WAYMARK_EXPORT waymark {

struct GraduationOptions {
  Loss loss;  ///< loss of the candidates at its final width. Default: Geman-McClure, 1
  TrustRule trusted = &odometry_edges;  ///< all others are candidates from the beginning
  /// trusted edges may become candidates, as above; false: they stay, and those that are contradicted are told only
  bool doubts_trusted = true;
  double factor = 1.4;       ///< divisor of the stretch per round, > 1
  int inner_iterations = 2;  ///< steps per round, >= 1
  /// probability of the quantile for the verdict, in (0, 1)
  double inlier_probability = 0.9999;
  /// for the last optimisation; observer and cancel token are used by all
  OptimizerOptions optimizer;

  GraduationOptions();
  /// @throws UsageError that names field, value and rule
  void check() const;
};

struct GraduationResult {
  Summary summary;                    ///< of the last optimisation, over all edges but the outliers
  std::vector<EdgePlace> outliers;    ///< in the order of the graph
  std::vector<EdgePlace> distrusted;  ///< those of them that the rule trusts
  std::vector<EdgePlace>
      contradicted;  ///< kept edges that the rule trusts and the other kept ones contradict
  /// kept candidates that alone join two parts which outliers would join elsewhere: nothing confirms them
  std::vector<EdgePlace> unconfirmed;
  /// Per batch and edge: the weight from the loss at its final width; 1 for trusted edges.
  std::vector<std::vector<double>> weights;
  std::size_t trusted = 0;     ///< edges that the rule trusts
  std::size_t candidates = 0;  ///< edges that may be outliers, at last
  /// rounds of narrowing; 0: all edges fit, or what was grown from the trusted edges does
  int rounds = 0;
  int passes = 0;      ///< splits whose minimum was computed
  int iterations = 0;  ///< steps of all optimisations
  double seconds = 0;
};

/// Finds outliers among the edges that are not trusted, and optimises over the other edges.
/// Edges' own losses are used in that last optimisation. The graph keeps all its edges and
/// receives the values.
/// @throws UsageError for invalid options; InputError as optimize() does
GraduationResult graduate(Graph& graph, Algorithm& algorithm, LinearSolver& solver,
                          const GraduationOptions& options);

}  // namespace waymark
