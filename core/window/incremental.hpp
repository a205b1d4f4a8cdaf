/// Optimisation of a graph that grows at its end and loses its oldest part, as a running
/// filter needs it.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <waymark/core/base/export.hpp>
#include <waymark/core/graph/graph.hpp>
#include <waymark/core/optimize/algorithm.hpp>
#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/core/system/structured_solver.hpp>
#include <waymark/core/window/marginalization.hpp>

namespace WAYMARK_EXPORT waymark {

/// Keeps structure and solver between calls:
///
///   IncrementalOptimizer optimizer(graph, algorithm, solver, {.max_iterations = 2});
///   for (...) {
///     graph.add_vertex(...); graph.add_edge(...);       // at will between calls
///     optimizer.update();                               // a few steps from the present values
///     optimizer.drop_prefix(*graph.find(oldest_id));    // everything before this pose
///   }
///
/// **How to begin.** Give the first pose a prior (EDGE_PRIOR_SE2) of what is known about it, with the
/// standard deviations of a first fix and of an unknown heading if that is all. Everything is determined
/// then from the first update on, and the covariances say how well. Without a prior the first pose is
/// held until two fixes at different places are in.
///
/// **Calibration states** (vertices without a place, such as biases) are ordered last. drop_prefix()
/// keeps those that join a pose that stays.
///
/// **Landmarks** are places without a stamp. In a graph whose poses have stamps, drop_prefix() keeps those
/// that join a pose that stays, wherever they were inserted. Without any stamps a landmark in the prefix
/// counts as a pose and is dropped (marginalize_prefix).
///
/// Between calls the caller may append to the graph, set values, and fix new vertices. Only
/// drop_prefix() may remove. The result of an update is that of optimize() from the same values, up
/// to the rounding of another order of elimination.
///
/// It owns algorithm and solver, and refers to the graph. drop_prefix() renumbers vertices and
/// edges: earlier indices, EdgePlace and spans become invalid, but ids stay valid. One thread at a
/// time may use the optimizer and its graph.
class IncrementalOptimizer {
 public:
  /// @param graph must outlive this object, at the same address
  /// @param options max_iterations is the number of steps per update
  /// @throws UsageError for invalid options
  IncrementalOptimizer(Graph& graph, std::unique_ptr<Algorithm> algorithm,
                       std::unique_ptr<LinearSolver> solver, OptimizerOptions options);

  /// Follows the appended vertices and edges, and optimises from the present values. While the
  /// measurements do not anchor the graph in all rigid motions (before the second fix), the first vertex
  /// is held at its present value, and a note of the summary says so.
  Summary update();

  /// Marginalises the first vertices at their present values (see marginalize_prefix). Vertices
  /// that find_gauge holds are held here too. Call it after update(), because the removed part
  /// should be near its minimum.
  Marginalization drop_prefix(VertexIndex count);

  /// Returns chi2 of everything that was dropped so far and is in no edge any more.
  [[nodiscard]] double dropped_chi2() const { return dropped_chi2_; }
  /// Returns the structure as of the last call.
  [[nodiscard]] const Structure& structure() const { return kept_.structure(); }

 private:
  void follow();

  Graph& graph_;
  std::unique_ptr<Algorithm> algorithm_;
  std::unique_ptr<LinearSolver> solver_;
  OptimizerOptions options_;
  StructuredSolver kept_;
  std::vector<char> held_;              // per vertex of the structure
  std::vector<std::string> notes_;      // about the gauge
  std::uint64_t followed_version_ = 0;  // of the graph
  double dropped_chi2_ = 0;
};

}  // namespace waymark
