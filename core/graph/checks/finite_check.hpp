/// Finds numbers that are not finite: no minimum and no covariance comes of them.
#pragma once

#include <optional>
#include <string>

#include <waymark/core/base/export.hpp>
#include <waymark/core/graph/graph.hpp>

namespace WAYMARK_EXPORT waymark {

/// Returns a sentence about the first vertex, or else the first edge, with a number that is not finite at
/// the present values: "EDGE_X number 3 (vertices 4 and 5): its error is not finite". An edge is examined
/// with its information, error, Jacobians and loss. If all are finite but the sum of their information is
/// not, the sentence is about the edge with the largest one. Empty if nothing is wrong. O(n).
[[nodiscard]] std::optional<std::string> find_not_finite(const Graph& graph);

}  // namespace waymark
