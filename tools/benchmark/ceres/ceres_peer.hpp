/// Runs Ceres on exactly the problem that a graph states, as fast as Ceres can. The errors are the
/// same, whitened by a root of the information matrix. Jacobians are those of the edge type if it
/// has them, or else Ceres's automatic ones. Each vertex is a parameter block. This header includes
/// no header of Ceres.
///
/// Ceres stops if an accepted step lowers chi2 by less than 1e-6 of its value (function_tolerance),
/// or by its own gradient and parameter tolerances. All other options are the defaults of Ceres
/// with SPARSE_NORMAL_CHOLESKY and one thread.
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

/// Minimises chi2. The graph then holds the result of Ceres. The gauge is fixed in the same way
/// as in Waymark.
/// @throws UsageError for a vertex type whose retraction is not plain addition; InputError
/// as find_gauge.
[[nodiscard]] RunOutcome optimize_with_ceres(Graph& graph, const CeresOptions& options);

/// Returns "Ceres 2.1.0".
[[nodiscard]] std::string ceres_version();

}  // namespace waymark::benchmark
