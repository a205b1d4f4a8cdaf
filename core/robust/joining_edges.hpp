/// Edges between parts of a graph that nothing else joins.
#pragma once

#include <span>
#include <vector>

#include <waymark/core/base/export.hpp>
#include <waymark/core/graph/graph.hpp>

namespace WAYMARK_EXPORT waymark {

/// Returns edges that would join parts of `kept` which nothing joins and of which nothing anchors one: its
/// rigid motions then make the error zero, so that nothing contradicts such an edge. innovations() holds each
/// part where it is and cannot tell. Two parts that are each anchored in part are joined where they have all
/// rigid motions between them, and keep those that both have: one that turns about its only fix, and one
/// whose heading alone is known, are anchored together.
///
/// Of several edges between the same parts the one that the others contradict least is returned; the first
/// one of those that they contradict by no more than noise.
/// @param edges of `graph`, none of them in `kept`, those that are preferred first
[[nodiscard]] std::vector<EdgePlace> joining_edges(const Graph& graph, std::span<const EdgePlace> edges,
                                                   const Graph& kept);

}  // namespace waymark
