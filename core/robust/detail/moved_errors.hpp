/// Errors of edges after one of their ends is moved.
#pragma once

#include <cstddef>
#include <span>

#include <waymark/core/graph/graph.hpp>
#include <waymark/core/system/detail/finite_motion.hpp>

namespace waymark::detail {

/// Returns e^T Omega e of an edge after some of its vertices are moved, without loss.
/// @param graph with the vertices; it gets its values back
[[nodiscard]] double squared_error_after(const EdgeBatchBase& batch, std::size_t edge, Graph& graph,
                                         std::span<const VertexIndex> moved, const FiniteMotion& motion);

/// Returns how many of some edges agree best on one motion: where the later end of each is moved as one of them
/// wants, the errors of so many, this one included, are within the bound. Right closures that a wrong
/// odometry edge contradicts agree, and so do false ones of one mistaken place; random ones do not. Of very many
/// edges only some are asked what they want. Edges of other than two vertices agree with none.
/// @param bound of e^T Omega e
[[nodiscard]] std::size_t most_that_agree(Graph graph, std::span<const EdgePlace> edges, double bound);

}  // namespace waymark::detail
