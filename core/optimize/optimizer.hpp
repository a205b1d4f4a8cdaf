/// The optimisation loop: minimises chi2 over the free vertices of a graph.
/// <waymark/solvers/optimize.hpp> chooses an algorithm, a solver and an initial guess.
///
/// optimize() keeps no argument after it returns. Threads: several calls may run at the same time
/// if they share no graph, algorithm or solver. A call starts and ends its own threads
/// (OptimizerOptions::threads). The calling thread calls the observer, which must not change the
/// graph. If the observer throws, the run ends and the graph has its original values.
#pragma once

#include <atomic>
#include <functional>

#include <waymark/core/base/export.hpp>
#include <waymark/core/graph/graph.hpp>
#include <waymark/core/optimize/algorithm.hpp>
#include <waymark/core/optimize/summary.hpp>
#include <waymark/core/system/structured_solver.hpp>

namespace WAYMARK_EXPORT waymark {

/// Convergence is declared if the values are stationary, or at a full (undamped, untruncated) Newton
/// step d. The unit u is 1, or the largest information of the graph if all of it is less:
///   gradient   max_i |g_i| / sqrt(H_ii) <= gradient_tolerance sqrt(u + chi2)
///   decrement  g^T H^-1 g <= decrement_tolerance (u + chi2)      the gain that the step promises
///              With losses min(chi2, degrees of freedom) takes the place of chi2, which outliers inflate,
///              and what is left to gain after the step, by the rate at which the steps shrink, is as small.
///   step       |d_i| <= step_tolerance (1 + |x|_max) for all i of the full step
///   chi2       chi2 <= decrement_tolerance u, if the algorithm has no step left that lowers it
/// The gradient test, at rounding level, is for an initial guess that already is a minimum. No test but step depends on
/// the units of the unknowns. A damped or truncated step never ends the run as converged, however small it is.
struct OptimizerOptions {
  int max_iterations = 500;           ///< limit on proposed steps, >= 0
  double decrement_tolerance = 1e-6;  ///< relative to u + chi2, > 0; the last step is still taken
  double gradient_tolerance = 1e-12;  ///< relative to sqrt(u + chi2), >= 0
  double step_tolerance = 1e-14;      ///< relative to 1 + largest value, >= 0

  /// Threads for linearisation and, if the backend has them, factorisation; >= 1. The result is the
  /// same, bit by bit, for any number.
  int threads = 1;

  /// Checked before every step; true ends the run with the best values so far.
  const std::atomic<bool>* cancel = nullptr;
  /// Called after every proposed step.
  std::function<void(const IterationRecord&)> observer = {};

  /// @throws UsageError that names field, value and rule
  void check() const;
};

/// Tells whether any edge has a loss, so that chi2 is no sum of squares. O(edges).
[[nodiscard]] bool has_losses(const Graph& graph);

/// Minimises chi2 of the graph; afterwards it holds the best values found, whatever the outcome. Newton's steps with
/// the whole curvature of the losses end the run where heavy tails make the algorithm converge slowly near a
/// minimum.
/// @throws UsageError for invalid options; InputError if the gauge is undetermined (see find_gauge)
Summary optimize(Graph& graph, Algorithm& algorithm, LinearSolver& solver, const OptimizerOptions& options);

/// Minimises chi2 with a structure and a symbolic analysis that the caller keeps between calls. The
/// gauge is not examined: everything that the structure does not hold must be determined.
/// @throws UsageError for invalid options, and if the structure does not follow the graph
Summary optimize(Graph& graph, StructuredSolver& solver, Algorithm& algorithm,
                 const OptimizerOptions& options);

}  // namespace waymark
