#include <algorithm>
#include <utility>

#include <waymark/core/system/gauge.hpp>
#include <waymark/core/window/incremental.hpp>

namespace waymark {

IncrementalOptimizer::IncrementalOptimizer(Graph& graph, std::unique_ptr<Algorithm> algorithm,
                                           std::unique_ptr<LinearSolver> solver, OptimizerOptions options)
    : graph_(graph),
      algorithm_(std::move(algorithm)),
      solver_(std::move(solver)),
      options_(std::move(options)),
      kept_(*solver_) {
  options_.check();
}

void IncrementalOptimizer::follow() {
  if (structure().pattern().version > 0 && followed_version_ == graph_.structure_version()) return;
  Gauge gauge = find_gauge(graph_, PartlyAnchored::hold_vertex);
  notes_ = std::move(gauge.messages);
  // If an old vertex becomes held, or is no longer held, its column changes. The structure then
  // starts over.
  const bool same =
      structure().pattern().version > 0 && std::equal(held_.begin(), held_.end(), gauge.held.begin());
  held_ = std::move(gauge.held);
  if (same) {
    kept_.extend(graph_, held_);
  } else {
    kept_.build(graph_, held_, true);
  }
  followed_version_ = graph_.structure_version();
}

Summary IncrementalOptimizer::update() {
  follow();
  Summary summary = optimize(graph_, kept_, *algorithm_, options_);
  summary.notes.insert(summary.notes.begin(), notes_.begin(), notes_.end());
  return summary;
}

Marginalization IncrementalOptimizer::drop_prefix(VertexIndex count) {
  follow();
  Marginalization result = marginalize_prefix(graph_, count, held_);
  dropped_chi2_ += result.constant;
  std::vector<char> held(graph_.vertex_count(), 0);
  for (std::size_t v = 0; v < held_.size(); ++v) {
    if (const VertexIndex now = result.removal.new_index[v]; now >= 0)
      held[static_cast<std::size_t>(now)] = held_[v];
  }
  held_ = std::move(held);
  kept_.remove(graph_, result.removal, held_);
  followed_version_ = graph_.structure_version();
  return result;
}

}  // namespace waymark
