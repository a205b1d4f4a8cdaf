/// The front door of the library: the minimum of a graph by one call, as the program finds it.
/// @code
///   Graph graph;
///   graph.add_vertex<VertexSe2>(VertexId{1}, {0, 0, 0});
///   ...
///   const MultiStartSummary summary = optimize(graph);
///   show(summary.brief());
/// @endcode Who wants to hold algorithm and solver in hand calls optimize() of
/// <waymark/core/optimize/optimizer.hpp>.
///
/// Ownership, threads and observer are those of that function. Every call has its own registry,
/// algorithm and solver, so calls on different graphs may run side by side.
#pragma once

#include <string>

#include <waymark/core/optimize/multi_start.hpp>
#include <waymark/core/registry/registry.hpp>

namespace waymark {

/// How optimize() goes about it. Every default is the program's.
struct Optimization {
  /// "auto": from the graph's own values, and from others if their minimum is implausible
  /// (multi_start.hpp); "file": from the graph's own values; or the name of a registered start:
  /// "odometry", "spanning_tree", "linear".
  std::string start = "auto";
  std::string algorithm = "dogleg";
  Options algorithm_options = {};
  std::string solver = "auto";   ///< "auto": the one registered first, which was the fastest measured
  OptimizerOptions limits = {};  ///< stopping rules, threads, observer, cancel token
};

/// Minimises chi2 with the solvers and starts that come with the library; on return the graph holds
/// the best values found.
/// @throws UsageError for a name or option that does not exist; InputError if the gauge is
/// undetermined
///         (find_gauge), or if the start asked for cannot be made
MultiStartSummary optimize(Graph& graph, const Optimization& how = {});

/// The same with the solvers, algorithms and starts of a registry, those of plugins among them.
MultiStartSummary optimize(Graph& graph, const TypeRegistry& registry, const Optimization& how = {});

}  // namespace waymark
