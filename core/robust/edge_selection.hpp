/// Single edges of a graph: the size of their errors, their agreement with the other edges, and the
/// graph without some of them.
///
/// Precondition: places belong to the graph of the same call. The functions keep nothing
/// after a call.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <waymark/core/base/export.hpp>
#include <waymark/core/graph/graph.hpp>

namespace WAYMARK_EXPORT waymark {

/// Returns e^T Omega e at the present values, without loss.
[[nodiscard]] double squared_error(const Graph& graph, EdgePlace place);
/// The same at the values of another graph of these vertices.
[[nodiscard]] double squared_error(const EdgeBatchBase& batch, std::size_t edge, const ValueView& values);

/// Returns a copy of the graph, losses included, without some edges. @param edges ascending
[[nodiscard]] Graph without_edges(const Graph& graph, std::span<const EdgePlace> edges);

/// Whether an edge belongs to the edges that innovations() compares it with.
enum class Membership {
  outside,  ///< it does not belong to them
  inside    ///< it belongs to them, and is compared with the others only
};

/// How an edge agrees with other edges. All is infinite if these determine nothing.
struct Innovation {
  double squared;  ///< e^T S^-1 e
  /// half the logarithm of det S / det Omega^-1: how much less surely the other edges predict what the edge
  /// measures than it measures it. An edge outside that they hardly predict agrees with them by chance.
  double looseness;
};

/// Compares edges of `graph` with the edges of `kept` (a graph of the same vertices at a minimum).
/// It returns e^T S^-1 e, with S = Omega^-1 + J P J^T for an edge outside and S = Omega^-1 - J P
/// J^T for an edge inside. P is the covariance of the unknowns. The result is chi-square
/// distributed if the edge is consistent with the others. It is also the amount by which the
/// minimum rises with the edge, or falls without it (exactly if errors are linear). It is zero for
/// an edge inside that no other edge checks, and infinite for all edges if the normal equations are
/// not positive definite.
///
/// Vertices that are held, fixed, or joined by no edge of `kept` count as known. A part that is held in some
/// coordinates only is free to do what its edges do not see: an edge outside is compared after the motion
/// that suits it best, and its looseness is infinite if that moves its error. The cost is one factorisation,
/// and per edge the part of a solve that inverse_form.hpp tells.
[[nodiscard]] std::vector<Innovation> innovations(const Graph& graph, std::span<const EdgePlace> edges,
                                                  Membership membership, const Graph& kept);

}  // namespace waymark
