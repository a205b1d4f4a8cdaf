/// Ceres on the very problem that a graph states, at its best: the same errors, whitened by a root of the
/// information; exact Jacobians by hand where the edge type has them, else Ceres's automatic ones; parameter
/// blocks per vertex. No header of Ceres is seen from here.
///
/// Stops when an accepted step lowers chi2 by less than 1e-6 of it (Ceres's function_tolerance), or by
/// Ceres's own gradient and parameter tolerances; all other options are Ceres's defaults with
/// SPARSE_NORMAL_CHOLESKY and one thread.
#pragma once

#include <atomic>
#include <string>

#include <waymark/core/graph/graph.hpp>
#include <waymark/tools/benchmark/measure.hpp>

namespace waymark::benchmark {

enum class CeresMethod { levenberg_marquardt, dogleg };

struct CeresOptions {
  CeresMethod method = CeresMethod::levenberg_marquardt;
  int max_iterations = 500;
  const std::atomic<bool>* cancel = nullptr;
  double function_tolerance = 1e-6;  ///< relative decrease of chi2
};

/// Minimises chi2; the graph then holds Ceres's result. What holds the gauge is held as Waymark holds it.
/// @throws UsageError for a vertex type whose retraction is not plain addition; InputError as find_gauge.
[[nodiscard]] RunOutcome optimize_with_ceres(Graph& graph, const CeresOptions& options);

/// "Ceres 2.1.0".
[[nodiscard]] std::string ceres_version();

}  // namespace waymark::benchmark
