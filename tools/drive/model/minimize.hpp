/// Minimises a graph as a Minimization states.
#pragma once

#include <atomic>
#include <functional>
#include <string>

#include <waymark/core/optimize/named_start.hpp>
#include <waymark/core/registry/registry.hpp>
#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>

namespace waymark::drive {

/// Observes a minimisation, and may end it.
struct MinimizationWatch {
  /// called for every step; empty: no observer
  std::function<void(const IterationRecord&)> observer{};
  const std::atomic<bool>* cancel = nullptr;  ///< as OptimizerOptions::cancel
};

/// Minimises from the initial guess that the settings choose (named_start.hpp). Afterwards the graph
/// holds the best values found.
/// @param search as for optimize_from
/// @throws UsageError for names that the registry does not have; InputError if the start cannot be
/// computed; errors of optimize()
MultiStartSummary minimize(Graph& graph, const Minimization& how, const TypeRegistry& registry,
                           const MinimizationWatch& watch = {}, const Minimizer& search = {});

/// Checks that start, algorithm, its options and solver exist. @throws UsageError
void check_minimization(const Minimization& how, const TypeRegistry& registry);

/// Returns the name of the linear solver that the settings choose.
[[nodiscard]] std::string solver_name(const Minimization& how, const TypeRegistry& registry);

/// Returns the stopping rules and threads.
[[nodiscard]] OptimizerOptions optimizer_options(const Minimization& how,
                                                 const MinimizationWatch& watch = {});

/// Fills document.covariances at the present values. Vertices that are not estimated get none.
/// @param which "none", "fixes" (vertices of fixes) or "all" (all vertices that are not fixed)
/// @throws InputError if the graph does not determine them
void add_covariances(formats::GraphDocument& document, const std::string& which);

}  // namespace waymark::drive
