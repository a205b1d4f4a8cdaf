/// Optimisation that chooses where to begin: the default configuration of the program.
///
/// A minimum says nothing about lower ones, but its chi2 does: under a model that holds, chi2 is distributed
/// as chi-square with one degree of freedom per number measured beyond the unknowns. So:
///   1. The values the graph came with are the first choice. Where the graph has loops, and chi2 at these
///      values is not already that of a minimum, the first registered start is made as well, and the one of
///      lower chi2 is taken (there a Newton step costs more than a start).
///   2. Where that run ends at a minimum whose chi2 is plausible, that is the result.
///   3. Else, or where the gauge cannot be judged at the values given, the other starts are tried, each for a
///      limited number of steps, until a minimum is plausible or a second start has ended at the lowest
///      minimum so far. The lowest is kept, and finished.
/// Evidence: types_se2/start/MEASUREMENTS.md.
#pragma once

#include <string>
#include <vector>

#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/core/registry/registry.hpp>

namespace waymark {

/// One start that was tried.
struct StartTrial {
  std::string start;  ///< "file" or a registered start's name
  double initial_chi2 = 0;
  double final_chi2 = 0;
  int iterations = 0;
  Termination termination = Termination::non_finite;
  double seconds = 0;  ///< making the start and optimising from it
};

/// The run that was kept, and all that were made.
struct MultiStartSummary {
  Summary summary;  ///< of the run kept; its notes say which start won where several were tried
  std::string start;
  std::vector<StartTrial> trials;
  double total_seconds = 0;
};

/// Largest chi2 at which a minimum is not called suspicious: degrees of freedom plus six standard deviations,
/// d + 6 sqrt(2 d). Axes without information count as measured, which errs on the side of trust.
[[nodiscard]] double plausible_chi2(const Graph& graph);

/// Optimises by the rule above; on return the graph holds the best values found.
/// options.max_iterations bounds the sum over all runs; the observer sees all of them.
/// @throws as optimize, where no start avoids it
MultiStartSummary optimize_from_best_start(Graph& graph, const RegistryTable<StartType>& starts,
                                           Algorithm& algorithm, LinearSolver& solver,
                                           const OptimizerOptions& options);

}  // namespace waymark
