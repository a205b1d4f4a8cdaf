/// Optimisation of a graph that grows at its end and loses its oldest part: what a running filter needs.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <waymark/core/graph/graph.hpp>
#include <waymark/core/optimize/algorithm.hpp>
#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/core/system/structure.hpp>
#include <waymark/core/window/marginalization.hpp>

namespace waymark {

/// Keeps structure and solver between calls:
///
///   IncrementalOptimizer optimizer(graph, algorithm, solver, {.max_iterations = 2});
///   for (...) {
///     graph.add_vertex(...); graph.add_edge(...);       // at will between calls
///     optimizer.update();                               // a few steps from the present values
///     optimizer.drop_prefix(*graph.find(oldest_id));    // what lies before the oldest pose to keep
///   }
///
/// Between calls the graph may be appended to, values may be set, and vertices that are new may be fixed;
/// only drop_prefix() may remove. The result of one update is that of optimize() from the same values, up to
/// the rounding of another elimination order.
class IncrementalOptimizer {
 public:
  /// @param graph must outlive this object and stay where it is
  /// @param options max_iterations is the number of steps of one update
  /// @throws UsageError for invalid options
  IncrementalOptimizer(Graph& graph, std::unique_ptr<Algorithm> algorithm,
                       std::unique_ptr<LinearSolver> solver, OptimizerOptions options);

  /// Follows what was appended and optimises from the present values.
  /// @throws InputError where the gauge is undetermined (find_gauge)
  Summary update();

  /// Marginalises the first vertices at their present values, see marginalize_prefix; what find_gauge holds
  /// is held. Best called after update(): what goes should be near the minimum.
  Marginalization drop_prefix(VertexIndex count);

  /// chi2 of all that was dropped so far and is in no edge any more.
  [[nodiscard]] double dropped_chi2() const { return dropped_chi2_; }
  /// As of the last call.
  [[nodiscard]] const Structure& structure() const { return structure_; }

 private:
  void follow();

  Graph& graph_;
  std::unique_ptr<Algorithm> algorithm_;
  std::unique_ptr<LinearSolver> solver_;
  OptimizerOptions options_;
  Structure structure_;
  std::vector<char> held_;              // per vertex that the structure knows
  std::vector<std::string> notes_;      // of the gauge
  std::uint64_t followed_version_ = 0;  // of the graph
  std::uint64_t analysed_version_ = 0;  // of the pattern; a pattern that was made has version 1 or more
  double dropped_chi2_ = 0;
};

}  // namespace waymark
