/// Odometry: the edges along the way of a drive, recognised by the ids of the poses.
#pragma once

#include <vector>

#include <waymark/core/base/export.hpp>
#include <waymark/core/graph/graph.hpp>

namespace WAYMARK_EXPORT waymark {

/// Returns the edges that continue a drive, ascending, and the priors of run-time arity, because marginalisation
/// made them from many edges. Insertion order would depend on the file, so the ids tell what continues what.
///
/// An edge of odometry joins two free vertices of one type that have a place in the plane, and determines one
/// from the other (its error has as many dimensions as the tangent). Of the vertices of this type the second
/// one has the next id that exists: 4, 5 where all are numbered, 40, 45 where keyframes are, and a landmark
/// may have an id between them. That alone would be chance, so the graph must give evidence:
///
/// - Most poses nearby are joined to their next one. If most are joined to the second or a later one instead
///   (at most the eighth), several drives whose ids are interleaved follow those; an edge between neighbours
///   by id is then one between two drives. If neither is so, the ids do not follow the drive, and nothing
///   there is odometry.
/// - The step of the ids is no leap: it is at most ten times the median nearby, or most poses nearby
///   are joined over such steps. The last pose of one drive and the first one of the next are neighbours by
///   id, too, and an edge between them is a claim about a place. Ids that run on from one drive to the next
///   give no such evidence.
///
/// Nothing is kept after the call. The cost is that of sorting, and of looking at 50 poses for each edge.
[[nodiscard]] std::vector<EdgePlace> odometry_edges(const Graph& graph);

}  // namespace waymark
