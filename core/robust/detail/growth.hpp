/// Growing a split from what is trusted.
#pragma once

#include <optional>
#include <vector>

#include <waymark/core/graph/graph.hpp>
#include <waymark/core/robust/detail/splits.hpp>

namespace waymark::detail {

/// Tells whether candidates can return to a graph without any: the candidates place what they join, or nothing else
/// says where that is. Elsewhere the innovations would take a place for known that nothing places.
[[nodiscard]] bool may_be_grown(const Splits& splits, const Graph& first);

/// Returns the outliers that remain if those that agree with the rest return, a share of them at a time. Those that the
/// rest predicts most surely come first: others may agree by chance, and once their betters are in, they do not.
/// What nothing joins is joined by one edge before. The cheapest split on the way counts.
/// @param out the first outliers @return none: it may not be grown
[[nodiscard]] std::optional<std::vector<EdgePlace>> grown_from(Splits& splits, std::vector<EdgePlace> out);

}  // namespace waymark::detail
