/// Single edges of a graph: how large their errors are, what the other edges say of them, and the graph
/// without some of them.
#pragma once

#include <compare>
#include <span>
#include <vector>

#include <waymark/core/graph/graph.hpp>
#include <waymark/core/linear/linear_solver.hpp>

namespace waymark {

/// An edge of a graph: its batch, and its place there.
struct EdgePlace {
  std::size_t batch = 0;
  std::size_t edge = 0;
  friend auto operator<=>(const EdgePlace&, const EdgePlace&) = default;
};

/// e^T Omega e at the present values, without loss.
[[nodiscard]] double squared_error(const Graph& graph, EdgePlace place);

/// A copy of the graph, losses included, that lacks some edges. @param edges ascending
[[nodiscard]] Graph without_edges(const Graph& graph, std::span<const EdgePlace> edges);

/// How an edge stands to the edges that innovations() judges it by.
enum class Membership {
  outside,  ///< they lack it
  inside    ///< they hold it; it is judged by the others alone
};

/// What the edges of `kept` (a graph of the same vertices at a minimum) say of edges of `graph`: e^T S^-1 e,
/// S = Omega^-1 + J P J^T for one outside, Omega^-1 - J P J^T for one inside, with P the covariance of the
/// unknowns. That is chi-square distributed where the edge belongs to the same world, and the amount by which
/// the minimum rises with the edge or falls without it (exactly where errors are linear). Zero for an
/// edge inside that no other checks; infinite for all where the normal equations are not positive definite.
///
/// Vertices that are held, fixed, or joined by no edge of `kept` count as known. One solve per edge and
/// dimension of its error.
[[nodiscard]] std::vector<double> innovations(const Graph& graph, std::span<const EdgePlace> edges,
                                              Membership membership, const Graph& kept, LinearSolver& solver);

}  // namespace waymark
