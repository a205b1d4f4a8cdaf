/// Optimisation that chooses its initial guess: the default configuration of the program.
///
/// A minimum does not show whether there are lower ones, but its chi2 gives a hint. If the model is
/// right, chi2 has a chi-square distribution with one degree of freedom for each measured number
/// beyond the unknowns. So:
/// 1. The first choice is the values that come with the graph. If the graph has loops, and chi2
///    at these values is above the degrees of freedom, the first registered start is computed
///    too. The one with lower chi2 is taken, because a Newton step costs more than a start in
///    such a graph.
/// 2. If that run ends at a minimum with a plausible chi2, it is the result. In a graph with few loops twice
///    the degrees of freedom are plausible: a long drive shows every error of its sigmas in chi2.
/// 3. Otherwise, or if the gauge cannot be judged at the given values, the other starts are tried,
///    each for a limited number of steps. This ends if a minimum is plausible, or if a second start
///    has ended at the lowest minimum so far. The lowest one is kept and run to its end.
///
/// types_se2/start/MEASUREMENTS.md has the evidence.
#pragma once

#include <string>
#include <vector>

#include <waymark/core/base/export.hpp>
#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/core/registry/registry.hpp>

namespace WAYMARK_EXPORT waymark {

/// One initial guess that was tried.
struct StartTrial {
  std::string start;  ///< "file" or the name of a registered start
  double initial_chi2 = 0;
  double final_chi2 = 0;
  int iterations = 0;
  Termination termination = Termination::non_finite;
  double seconds = 0;  ///< time to compute the initial guess and to optimise from it
};

/// The run that was kept, and all runs.
struct MultiStartSummary {
  Summary summary;  ///< of the kept run; if several starts were tried, its notes name the best
  std::string start;
  std::vector<StartTrial> trials;
  double total_seconds = 0;

  [[nodiscard]] bool converged() const { return summary.converged(); }
  /// Text as from Summary. The full text also has the start, and the time of all starts if there
  /// were several.
  [[nodiscard]] std::string brief() const { return summary.brief(); }
  [[nodiscard]] std::string full() const;
};

/// Returns the largest chi2 at which a minimum is not suspicious: degrees of freedom plus six
/// standard deviations, d + 6 sqrt(2 d). What the gauge holds is no unknown. Axes without information count as
/// measured, so the test rather accepts than rejects.
[[nodiscard]] double plausible_chi2(const Graph& graph);

/// Optimises by the rule above. Afterwards the graph holds the best values found.
/// options.max_iterations limits the sum over all runs, and the observer sees all of them.
/// Ownership, threads and observer are those of optimize(). Each start needs one more copy of the
/// graph's values.
/// @throws as optimize, if no start avoids it
MultiStartSummary optimize_from_best_start(Graph& graph, const RegistryTable<StartType>& starts,
                                           Algorithm& algorithm, LinearSolver& solver,
                                           const OptimizerOptions& options);

}  // namespace waymark
