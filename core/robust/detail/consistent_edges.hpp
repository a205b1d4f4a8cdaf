/// The largest sets of candidates that are consistent with each other, pair by pair.
#pragma once

#include <vector>

#include <waymark/core/robust/detail/splits.hpp>

namespace waymark::detail {

/// Returns the largest found sets of candidates, the largest first. Every two of a set are consistent: with the
/// trusted edges and one of the two, the innovation of the other is within its bound. (Mangelson, Dominic, Eustice,
/// Vasudevan, "Pairwise Consistent Measurement Set Maximization for Robust Multi-robot Map Merging", ICRA 2018; here
/// with the innovation in the place of the error of a loop, so that any edge can be asked.) Right closures agree with
/// each other, however few they are; false ones with few others, by chance.
///
/// One minimum per candidate is computed, from the values that the graph has.
/// @return each ascending, with those that only join parts; none if interrupted, or where a candidate determines no
/// solution
[[nodiscard]] std::vector<std::vector<EdgePlace>> consistent_edges(Splits& splits);

}  // namespace waymark::detail
