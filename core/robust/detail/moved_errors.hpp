/// Errors of edges after one of their ends is moved.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <waymark/core/base/export.hpp>
#include <waymark/core/graph/graph.hpp>
#include <waymark/core/system/detail/finite_motion.hpp>

namespace waymark::detail {

/// Returns e^T Omega e of an edge after some of its vertices are moved, without loss.
/// @param graph with the vertices; it gets its values back
[[nodiscard]] double squared_error_after(const EdgeBatchBase& batch, std::size_t edge, Graph& graph,
                                         std::span<const VertexIndex> moved, const FiniteMotion& motion);

/// Returns the most of some edges that agree on one motion: where the later end of each is moved as one of them
/// wants, their errors are within the bound. Right closures that a wrong
/// odometry edge contradicts agree, and so do false ones of one mistaken place; random ones do not. Of very many
/// edges only some are asked what they want. Edges of other than two vertices agree with none.
/// @param bound of e^T Omega e
[[nodiscard]] std::vector<EdgePlace> most_that_agree(Graph graph, std::span<const EdgePlace> edges,
                                                     double bound);

/// Returns how many of some edges agree on one motion by chance: if they are of random motions anywhere in the area
/// of the poses, one of a hundred such sets has more. Edges without information on some axis do not count.
/// @param graph at values that tell the area @param bound as above
[[nodiscard]] WAYMARK_EXPORT std::size_t most_by_chance(const Graph& graph, std::span<const EdgePlace> edges,
                                                        double bound);

}  // namespace waymark::detail
