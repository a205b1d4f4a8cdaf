/// Tests what a vertex type and a loss promise (vertex.hpp, loss.hpp), for `waymark check --derivatives`
/// and the conformance tests.
#pragma once

#include <string>
#include <vector>

#include <waymark/core/base/export.hpp>
#include <waymark/core/graph/loss.hpp>
#include <waymark/core/graph/vertex.hpp>

namespace WAYMARK_EXPORT waymark {

/// Returns a sentence for each broken promise; empty if there is none. The result is the same in every
/// run. Tested: retract by 0 changes nothing; local(v, v) = 0; local is the inverse of retract; a linear
/// chart is one (linear_chart); rigid motions move the position as a rigid motion does.
[[nodiscard]] std::vector<std::string> broken_promises(const VertexType& type);

/// Tested: all numbers are finite; rho(0) = 0 and rho'(0) = 1; the weight lies in [0, 1] and never grows;
/// weight and curvature are the first and second derivative of rho, by differences.
[[nodiscard]] std::vector<std::string> broken_promises(const LossType& type);

}  // namespace waymark
