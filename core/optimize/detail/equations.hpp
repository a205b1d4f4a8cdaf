/// The number of scalar errors of a graph.
#pragma once

#include <cstdint>

#include <waymark/core/graph/graph.hpp>

namespace waymark::detail {

/// O(1) for each batch whose edges have one dimension.
[[nodiscard]] inline std::int64_t count_equations(const Graph& graph) {
  std::int64_t count = 0;
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    const EdgeBatchBase& batch = graph.batch(b);
    const std::int64_t dimension = graph.edge_type(b).error_dimension;  // 0: each edge has its own
    count += dimension * static_cast<std::int64_t>(batch.size());
    for (std::size_t e = 0; dimension == 0 && e < batch.size(); ++e) count += batch.error_dimension(e);
  }
  return count;
}

}  // namespace waymark::detail
