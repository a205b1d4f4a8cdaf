/// Trusted edges that may be wrong, and kept ones that nothing checks.
#pragma once

#include <vector>

#include <waymark/core/robust/detail/splits.hpp>

namespace waymark::detail {

/// Makes candidates of the trusted edges that the best split contradicts most. A wrong edge may bend the rest so
/// that its own error is small. If chi2 or closures outside tell that something may be wrong, all are asked what it
/// costs to keep them.
/// @return there is a cheaper split now; otherwise every edge keeps its role
bool doubt_trusted(Splits& splits);

/// Lets the outliers that want the same return, and doubts the trusted edges that they accuse. Nothing else shows an
/// edge that is wrong by so little that it costs less than its price once they are out.
/// @return there is a cheaper split now; otherwise every edge keeps its role
bool doubt_for_agreeing(Splits& splits);

/// Returns the edges that the rule trusts, are inside the best split, and are beyond their bound at the values of the
/// graph, ascending.
[[nodiscard]] std::vector<EdgePlace> contradicted_inside(const Splits& splits);

/// Returns the candidates inside the best split that no other edge checks, although outliers join the same parts
/// elsewhere, ascending. The graph has the values of that split.
[[nodiscard]] std::vector<EdgePlace> unconfirmed(const Splits& splits);

}  // namespace waymark::detail
