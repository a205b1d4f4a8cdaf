/// The front door of the library: finds the minimum of a graph in one call, as the program does.
/// @code
///   Graph graph;
///   graph.add_vertex<VertexSe2>(VertexId{1}, {0, 0, 0});
///   ...
///   const MultiStartSummary summary = optimize(graph);
///   show(summary.brief());
/// @endcode
/// A caller with its own algorithm and solver uses optimize() of
/// <waymark/core/optimize/optimizer.hpp>.
///
/// Ownership, threads and observer are those of optimize() there. Every call has its own registry,
/// algorithm and solver, so calls for different graphs may run at the same time.
#pragma once

#include <string>

#include <waymark/core/optimize/multi_start.hpp>
#include <waymark/core/registry/registry.hpp>

namespace waymark {

/// The settings of optimize(). Every default is that of the program.
struct Optimization {
  /// "auto": begin at the values of the graph, and at others if their minimum is implausible
  /// (multi_start.hpp). "file": begin at the values of the graph. Otherwise it is the name of a
  /// registered start: "odometry", "spanning_tree", "linear".
  std::string start = "auto";
  std::string algorithm = "dogleg";
  Options algorithm_options = {};
  /// "auto": the first one registered, which is the fastest in measurements
  std::string solver = "auto";
  Options solver_options = {};
  OptimizerOptions limits = {};  ///< stopping rules, threads, observer, cancel token
};

/// Minimises chi2 with the solvers and starts of the library. Afterwards the graph holds the best
/// values found.
/// @throws UsageError for a name or option that does not exist; InputError if the gauge is
/// undetermined (find_gauge), or if the chosen start cannot be computed
MultiStartSummary optimize(Graph& graph, const Optimization& how = {});

/// Does the same with the solvers, algorithms and starts of a registry, which may come
/// from plugins.
MultiStartSummary optimize(Graph& graph, const TypeRegistry& registry, const Optimization& how = {});

}  // namespace waymark
