/// Residuals of a graph by edge type, whitened: which edges do not fit, and whether the errors of a type are
/// as large as its information says.
///
/// **Whitened** is w = C^(1/2) D e with D = diag(sqrt(Omega_kk)) and C = D^-1 Omega D^-1, the symmetric root
/// of the correlation: |w|^2 = e^T Omega e, the unit of no component matters, and component k of w stays as
/// near to component k of e as any whitening lets it (Kessy, Lewin, Strimmer 2018, "ZCA-cor"). Of a component
/// that the information knows nothing of (Omega_kk = 0) w is NaN and left out of all statistics.
///
/// **What to expect**: were the noise as stated, each w would be white with variance 1 before the fit; after
/// it, less, as the unknowns take part of it up. Over a whole graph the rms is about sqrt(1 - unknowns /
/// components) (GraphResiduals::expected_rms). By type nothing so simple holds: edges that others check
/// little (odometry between two fixes, the steps of a state's random walk) come out well below 1 even where
/// the noise is as stated. Three kinds are told apart (EdgeRole), since the last two are no measurements.
/// Information is what the edge holds: under a modeling whose fixes share states (`correlated`) that of a fix
/// is of its own white part only (times 1.5 under Student's t), and the rest of its error lies in the states.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <waymark/core/graph/graph.hpp>
#include <waymark/tools/evaluation/numbers/metrics.hpp>

namespace waymark::evaluation {

/// What the edges of a type stand for.
enum class EdgeRole {
  measurement,  ///< a reading: odometry, a fix, a loop closure, a gyro at rest
  process,      ///< how a state without a place (a bias, a scale) goes on from one of its values to the next
  prior         ///< what was said beforehand of a state, or what marginalised vertices left
};

/// "measurement", "process", "prior".
[[nodiscard]] const char* to_string(EdgeRole role);

/// One edge at the values of the graph.
struct EdgeResidual {
  std::size_t edge = 0;        ///< its place in the batch of its type, 0-based
  std::optional<Stamp> stamp;  ///< the latest of its vertices' stamps; empty: none has one
  double squared = 0;          ///< |w|^2 = e^T Omega e
  double rho = 0;              ///< what it adds to chi2: rho(squared)
  double weight = 1;           ///< of the loss: rho'(squared); 1 without a loss
};

/// An edge among the largest of its type.
struct LargeResidual {
  EdgeResidual residual;
  std::vector<VertexId> vertices;
  std::vector<double> whitened;  ///< its components
};

/// One component of a type's whitened error.
struct ResidualComponent {
  std::string name;             ///< "x", "y", "heading" where the form says so, else its number from 1
  ScalarStatistics statistics;  ///< of w; count: edges whose information knows the component
};

/// All edges of one type.
struct TypeResiduals {
  std::string tag;
  std::string form;  ///< how the error is formed: "(t, theta)", "log", "position", ...
  EdgeRole role = EdgeRole::measurement;
  std::size_t dimension = 0;  ///< of the error; of the largest error where each edge has its own
  double squared = 0;         ///< sum of e^T Omega e
  double chi2 = 0;            ///< sum of rho(e^T Omega e)
  double squared_share = 0;   ///< of the graph's, in [0, 1]; 0 where that is 0
  double chi2_share = 0;
  std::size_t robust = 0;                     ///< edges with a loss
  double weight_sum = 0;                      ///< over all edges: how many of them count, in effect
  std::vector<ResidualComponent> components;  ///< `dimension` of them
  std::vector<LargeResidual> largest;         ///< by `squared`, the largest first; equal ones in order
  std::vector<EdgeResidual> edges;            ///< every edge, in order
  /// w of every edge: edge i's component k at [i dimension + k]; NaN where an edge has none or knows none.
  std::vector<double> whitened;
};

struct GraphResiduals {
  std::vector<TypeResiduals> types;  ///< those that have edges, in the graph's order
  double squared = 0;
  double chi2 = 0;
  std::size_t components = 0;  ///< scalar errors that carry information

  /// Root of the mean square to be expected of all whitened components together, were the noise as stated and
  /// white: sqrt(1 - unknowns / components); 0 where the graph has no more errors than unknowns.
  /// @param unknowns  scalar ones: Summary::unknowns
  [[nodiscard]] double expected_rms(std::int64_t unknowns) const;
};

/// Residuals of every edge at the graph's present values. Linear in the number of edges; 30 ms for 100,000.
/// @param most  edges to be listed as the largest, per type
[[nodiscard]] GraphResiduals residuals_by_type(const Graph& graph, std::size_t most = 10);

}  // namespace waymark::evaluation
