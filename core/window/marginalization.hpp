/// Fixed lag: removes the oldest vertices of a graph, and keeps the information of their edges
/// about the others as a prior.
///
/// The graph belongs to the caller and is changed. Earlier indices, EdgePlace and spans
/// become invalid.
#pragma once

#include <span>

#include <waymark/core/base/export.hpp>
#include <waymark/core/graph/graph.hpp>

namespace WAYMARK_EXPORT waymark {

/// The result of marginalize_prefix.
struct Marginalization {
  /// old index -> new index, and the kept edges; Structure::remove needs it
  Removal removal;
  std::size_t priors = 0;  ///< so many last edges of the batch EDGE_GAUSSIAN_PRIOR are new
  /// The part of chi2 that is in no edge any more: chi2 of the removed edges at their (quadratic)
  /// minimum. The old graph's chi2, minimised over the removed vertices, equals the new graph's
  /// chi2 + constant.
  double constant = 0;
};

/// Removes the first `count` vertices of the graph and every edge that touches one of them. The
/// removed edges, linearised at the present values, also have information about vertices that stay.
/// This is kept as a prior. Over x_s, with H and g of the removed edges alone, it is
///   Lambda = H_ss - H_sr H_rr^-1 H_rs,   h = g_s - H_sr H_rr^-1 g_r.
/// It is added as EDGE_GAUSSIAN_PRIOR with the present values as reference and offset d = -Lambda^+
/// h, one edge for each group of vertices that the removed edges join. If Lambda is singular (no
/// removed edge knows the position), the pseudo-inverse still keeps form and gradient, because h is
/// in its range. The prior is computed from square roots (QR), vertex by vertex in the order of time, so
/// that nothing is squared before it cancels. The cost does not grow with the remaining graph,
/// except for a pass over the vertices of every edge and for moving the rest.
///
/// The result is exact if errors are linear. Otherwise it is exact to second order at the present
/// values, which therefore should be near the minimum. The step, the minimum found from there, and
/// its covariances are then those of the whole graph.
///
/// Some vertices of the prefix stay: those of a dense type; states (vertices without a place) that join a
/// vertex with a place that stays, and, in a graph with stamps, those without one, which belong to no
/// time; in such a graph, places without a stamp (landmarks) that join one that stays; and fixed vertices
/// that remaining edges touch. Fixed vertices count as known, and so do those in `held`. A held vertex goes
/// with the prefix, and the prior then anchors the rest at its place. A fixed origin that no remaining edge
/// touches (GNSS outage) goes too; a caller that needs it later adds it again with the same id. Robust losses
/// enter with their weights and second-order terms at the present values (robust_information.hpp), frozen.
///
/// @param held per vertex, or empty: wholly held ones (held_marks.hpp) are known besides the fixed ones, as find_gauge
/// returns them. Without it, a graph that nothing anchors stays so to first order. The prior is
/// quadratic in the axes of the frame, so a later turn of the whole graph by more than a little
/// would strain it.
/// @throws UsageError if count is not in 0..vertex_count(), and if the batch EDGE_GAUSSIAN_PRIOR
/// has a loss as a whole; InputError if the removed edges do not determine a removed vertex, or are
/// not finite. The graph is then unchanged.
[[nodiscard]] Marginalization marginalize_prefix(Graph& graph, VertexIndex count,
                                                 std::span<const char> held = {});

}  // namespace waymark
