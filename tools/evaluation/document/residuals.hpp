/// Residuals of a graph by edge type, whitened. They show which edges do not fit, and whether the
/// errors of a type are as large as its information says.
///
/// **Whitened** is w = C^(1/2) D e with D = diag(sqrt(Omega_kk)) and C = D^-1 Omega D^-1, using the
/// symmetric root of the correlation. So |w|^2 = e^T Omega e, the units of components do not
/// matter, and component k of w is as near to component k of e as whitening allows (Kessy, Lewin,
/// Strimmer 2018, "ZCA-cor"). If the information of a component is zero (Omega_kk = 0), its w is
/// NaN and left out of all statistics.
///
/// **Expected values**: if the noise is as stated, each w is white with variance 1 before the fit.
/// After the fit it is smaller, because the unknowns absorb a part. Over a whole graph the rms is
/// about sqrt(1 - unknowns / components) (GraphResiduals::expected_rms). There is no such rule for
/// a single type. Edges with little redundancy (odometry between two fixes, the random-walk steps
/// of a state) have an rms well below 1 even if the noise is as stated.
///
/// There are three kinds of edges (EdgeRole), because process edges and priors are no measurements.
/// The information is that of the edge. In a modeling whose fixes share states (`correlated`), the
/// edge of a fix has only the information of its white part (times 1.5 for Student's t); the rest
/// of its error is in the states.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <waymark/core/graph/graph.hpp>
#include <waymark/tools/evaluation/numbers/metrics.hpp>

namespace waymark::evaluation {

/// The role of the edges of a type.
enum class EdgeRole {
  measurement,  ///< a reading: odometry, a fix, a loop closure, a gyro at rest
  /// a step of a state without a place (a bias, a scale) from one of its values to the next
  process,
  prior  ///< prior knowledge of a state, or the rest of marginalised vertices
};

/// Returns "measurement", "process" or "prior".
[[nodiscard]] const char* to_string(EdgeRole role);

/// One edge at the values of the graph.
struct EdgeResidual {
  std::size_t edge = 0;        ///< its index in the batch of its type
  std::optional<Stamp> stamp;  ///< the latest stamp of its vertices; empty: none has one
  double squared = 0;          ///< |w|^2 = e^T Omega e
  double rho = 0;              ///< its part of chi2: rho(squared)
  double weight = 1;           ///< weight from the loss: rho'(squared); 1 without a loss
};

/// One of the largest edges of its type.
struct LargeResidual {
  EdgeResidual residual;
  std::vector<VertexId> vertices;
  std::vector<double> whitened;  ///< components of its whitened error
};

/// One component of the whitened error of a type.
struct ResidualComponent {
  /// "x", "y", "heading" if the form defines them, else its number from 1
  std::string name;
  ScalarStatistics statistics;  ///< of w; count: edges with information on the component
};

/// All edges of one type.
struct TypeResiduals {
  std::string tag;
  std::string form;  ///< form of the error: "(t, theta)", "log", "position", ...
  EdgeRole role = EdgeRole::measurement;
  std::size_t dimension = 0;  ///< of the error; of the largest error if the dimension varies
  double squared = 0;         ///< sum of e^T Omega e
  double chi2 = 0;            ///< sum of rho(e^T Omega e)
  double squared_share = 0;   ///< share of the graph's sum, in [0, 1]; 0 if that is 0
  double chi2_share = 0;
  std::size_t robust = 0;                     ///< edges with a loss
  double weight_sum = 0;                      ///< sum over all edges: the effective number of edges
  std::vector<ResidualComponent> components;  ///< `dimension` of them
  /// by `squared`, largest first; equal ones in the order of the batch
  std::vector<LargeResidual> largest;
  std::vector<EdgeResidual> edges;  ///< every edge, in order
  /// w of every edge: component k of edge i is at [i dimension + k]. It is NaN if the edge has no
  /// such component, or no information on it.
  std::vector<double> whitened;
};

struct GraphResiduals {
  std::vector<TypeResiduals> types;  ///< types with edges, in the order of the graph
  double squared = 0;
  double chi2 = 0;
  std::size_t components = 0;  ///< scalar errors with information

  /// Returns the expected rms of all whitened components, if the noise is as stated and white:
  /// sqrt(1 - unknowns / components). It is 0 if the graph has no more errors than unknowns.
  /// @param unknowns scalar ones: Summary::unknowns
  [[nodiscard]] double expected_rms(std::int64_t unknowns) const;
};

/// Returns the latest stamp of the vertices of an edge; empty if none has one.
[[nodiscard]] std::optional<Stamp> latest_stamp(const Graph& graph, std::span<const VertexIndex> vertices);

/// Returns the residuals of every edge at the present values of the graph. The time is linear in
/// the number of edges: 30 ms for 100,000.
/// @param most number of largest edges to list, per type
[[nodiscard]] GraphResiduals residuals_by_type(const Graph& graph, std::size_t most = 10);

}  // namespace waymark::evaluation
