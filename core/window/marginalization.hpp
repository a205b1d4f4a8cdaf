/// Fixed lag: the oldest vertices of a graph go, and what their edges said of the others stays as a prior.
#pragma once

#include <span>

#include <waymark/core/graph/graph.hpp>

namespace waymark {

/// What marginalize_prefix left.
struct Marginalization {
  Removal removal;         ///< old index -> new index, and the edges kept: Structure::remove wants it
  std::size_t priors = 0;  ///< the last ones of the batch EDGE_GAUSSIAN_PRIOR are new
  /// chi2 that is in no edge any more: that of the removed edges at their (quadratic) minimum. chi2 of the
  /// graph as it was, minimised over what is gone = chi2 of the graph as it is + constant.
  double constant = 0;
};

/// Removes the first `count` vertices of the graph and every edge that touches one of them, and adds what
/// those edges, linearised at the present values, say of the vertices that stay: over x_s with H and g of the
/// removed edges alone,
///   Lambda = H_ss - H_sr H_rr^-1 H_rs,   h = g_s - H_sr H_rr^-1 g_r,
/// as EDGE_GAUSSIAN_PRIOR with reference the present values, information Lambda and offset d = -Lambda^+ h;
/// one for each group of vertices that the removed edges join. Where Lambda is singular (nothing removed
/// knows the position) the pseudo-inverse keeps form and gradient all the same, as h lies in its range.
/// Computed from square roots, vertex by vertex in their order (QR), so that nothing is squared before it
/// cancels. The cost does not grow with what stays, but for one look at every edge's vertices and for moving
/// up what stays.
///
/// Exact where errors are linear. Elsewhere exact to second order at the present values, which therefore
/// should be near the minimum: the step, the minimum found from there, and its covariances are those of the
/// whole graph.
///
/// What of the prefix stays: vertices of a dense type (calibration states belong to no time), and fixed
/// vertices that remaining edges touch. Fixed vertices count as known, and so do those in `held`; a held one
/// goes with the prefix, and the prior then anchors the rest where it stood. A fixed origin that no edge of
/// the window touches any more (GNSS outage) goes too; who needs it later adds it again, under the same id.
/// Robust losses count with their weights and second-order terms at the present values
/// (robust_information.hpp); from then on they are frozen.
///
/// @param held per vertex, or empty: known beside the fixed ones, as find_gauge says. Without it a graph that
///   nothing anchors stays so, to first order: the prior is quadratic in the frame's axes, and later turns of
///   the whole graph by more than a little would strain it.
/// @throws UsageError for a count that is not in 0..vertex_count(), and where the batch EDGE_GAUSSIAN_PRIOR
///   as a whole has a loss; InputError where the removed edges do not determine a removed vertex, or are not
///   finite. The graph is then unchanged.
[[nodiscard]] Marginalization marginalize_prefix(Graph& graph, VertexIndex count,
                                                 std::span<const char> held = {});

}  // namespace waymark
