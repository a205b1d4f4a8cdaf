/// Compares the Jacobians of edges with derivatives nobody wrote by hand.
#pragma once

#include <string>

#include <waymark/core/graph.hpp>

namespace waymark {

/// The largest disagreement found in one batch.
struct GradientCheck {
  std::size_t edges = 0;  ///< compared
  double error = 0;       ///< |given - reference| / (1 + |reference|), largest over all entries
  std::size_t edge = 0;   ///< where
  int vertex = 0;         ///< which of the edge's vertices
  int row = 0;
  int column = 0;
  double given = 0;
  double reference = 0;
};

/// Compares up to `most` edges of a batch (evenly spread) with central differences of the error at the
/// present values. Differences are good to about 1e-7 relative to the error's size; a wrong Jacobian is off
/// by far more.
[[nodiscard]] GradientCheck check_gradients(const Graph& graph, std::size_t batch, std::size_t most);

}  // namespace waymark
