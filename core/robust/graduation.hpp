/// Graduated non-convexity: optimisation that finds the outliers among the edges.
///
/// Yang, Antonante, Tzoumas, Carlone, "Graduated Non-Convexity for Robust Spatial Perception", RA-L 2020,
/// with any loss: the candidates' loss is m rho(s / m), with a stretch m so large at first that it is convex
/// up to the largest error at the start; every round divides m by a factor and takes a few steps, until m
/// = 1. For Geman-McClure this is the paper's schedule of mu.
///
/// The loss narrows to *less* than the noise of a good edge, so that of several groups of edges that agree
/// among themselves the one that fits best wins, not the one that bends the graph just inside the gate. A
/// verdict is then passed without any loss, by one criterion: over splits of the candidates into kept and
/// outliers,
///   cost = chi2 at the minimum of the kept edges + chi-square quantile of each outlier
/// (truncated least squares). From a split by the edges' errors it is lowered edge by edge: an outlier whose
/// innovation (edge_selection.hpp) is within the quantile returns, a kept edge beyond it goes. How narrow is
/// best depends on how honest the stated noise is, so verdicts are passed at stretch 16, 4 and 1 of the last
/// width, and the cheapest counts.
#pragma once

#include <functional>
#include <vector>

#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/core/robust/edge_selection.hpp>

namespace waymark {

/// Whether an edge is never doubted.
using TrustRule = std::function<bool(const Graph&, EdgePlace)>;

/// Odometry: the edge joins two free vertices of one type that have a place in the plane and whose ids follow
/// each other, and its error determines one from the other (as many dimensions as the tangent). Priors of
/// run-time arity are trusted as well: they are what marginalisation left of many edges.
[[nodiscard]] bool is_odometry_edge(const Graph& graph, EdgePlace place);

struct GraduationOptions {
  Loss loss;                              ///< of the candidates; its final width. Default: Geman-McClure, 1
  TrustRule trusted = &is_odometry_edge;  ///< all others are candidates
  double factor = 1.4;                    ///< of the stretch, per round, > 1
  int inner_iterations = 2;               ///< steps of a round, >= 1
  double inlier_probability = 0.9999;     ///< quantile of the verdict, in (0, 1)
  OptimizerOptions optimizer;             ///< of the last optimisation; observer and cancel token serve all

  GraduationOptions();
  /// @throws UsageError naming field, value and rule.
  void check() const;
};

struct GraduationResult {
  Summary summary;                  ///< of the last optimisation, over all edges but the outliers
  std::vector<EdgePlace> outliers;  ///< in the order of the graph
  /// Per batch and edge: the weight that the loss gave at its final width; 1 for trusted edges.
  std::vector<std::vector<double>> weights;
  std::size_t candidates = 0;
  int rounds = 0;      ///< of narrowing; 0: no edge was beyond its quantile at the minimum of all
  int passes = 0;      ///< splits whose minimum was looked for
  int iterations = 0;  ///< steps of all optimisations together
  double seconds = 0;
};

/// Finds outliers among the edges that are not trusted, and optimises over the rest; losses that the edges
/// have of their own count in that last optimisation. The graph keeps all its edges and gets the values.
/// @throws UsageError for invalid options; InputError as optimize() does.
GraduationResult graduate(Graph& graph, Algorithm& algorithm, LinearSolver& solver,
                          const GraduationOptions& options);

}  // namespace waymark
