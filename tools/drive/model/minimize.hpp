/// Minimises a graph as the settings say.
#pragma once

#include <atomic>
#include <functional>
#include <string>

#include <waymark/core/optimize/multi_start.hpp>
#include <waymark/core/registry/registry.hpp>
#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>

namespace waymark::drive {

/// Who watches a minimisation, and who may end it.
struct MinimizationWatch {
  std::function<void(const IterationRecord&)> observer{};  ///< told of every step; empty: nobody
  const std::atomic<bool>* cancel = nullptr;               ///< as OptimizerOptions::cancel
};

/// A search around optimize(), to be run in its place.
using Minimizer = std::function<Summary(Graph&, Algorithm&, LinearSolver&, const OptimizerOptions&)>;

/// Minimises from the start that the settings name; the graph holds the best values found. A search for
/// outliers begins at the values at hand instead of the best start: chi2 over all edges says nothing about a
/// start if some of them are false.
/// @param search  instead of optimize(); empty: that one
/// @throws UsageError for what the registry does not have; InputError if the start cannot be made; what
/// optimize() throws
MultiStartSummary minimize(Graph& graph, const Minimization& how, const TypeRegistry& registry,
                           const MinimizationWatch& watch = {}, const Minimizer& search = {});

/// Whether start, algorithm, its options and solver exist. @throws UsageError
void check_minimization(const Minimization& how, const TypeRegistry& registry);

/// Name of the linear solver that the settings name.
[[nodiscard]] std::string solver_name(const Minimization& how, const TypeRegistry& registry);

/// Stopping rules and threads.
[[nodiscard]] OptimizerOptions optimizer_options(const Minimization& how,
                                                 const MinimizationWatch& watch = {});

/// What is said of vertices that are not joined to the rest.
[[nodiscard]] std::string apart_note(std::size_t vertices);

/// Fills document.covariances at the present values. Vertices that are not estimated get none.
/// @param which  "none", "fixes" (vertices of fixes) or "all" (whatever is not fixed)
/// @throws InputError if the graph does not determine them
void add_covariances(formats::GraphDocument& document, const std::string& which);

}  // namespace waymark::drive
