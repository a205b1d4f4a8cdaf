/// Narrowing the loss of the candidates: graduated non-convexity itself.
#pragma once

#include <waymark/core/robust/detail/splits.hpp>

namespace waymark::detail {

/// Narrows the loss of the candidates from the present values of the graph, and judges the splits that their errors
/// show on the way. Wide enough at first, the loss is convex at every candidate; then it is as wide as stated.
/// @return the rounds of narrowing
int narrow(Splits& splits);

}  // namespace waymark::detail
