/// The unit in which a graph measures: whether a number is small can only be judged beside it.
#pragma once

#include <waymark/core/graph/graph.hpp>

namespace waymark {

/// Returns the largest number on the diagonals of all information matrices, but at most 1. It is 1 if
/// the first edge says so; a graph of faint edges only is looked through. 1 also if there is no
/// information at all.
[[nodiscard]] double information_unit(const Graph& graph);

}  // namespace waymark
