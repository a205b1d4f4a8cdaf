/// The common part of all vertices that are one plain number: biases, scales, offsets.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <waymark/core/base/export.hpp>
#include <waymark/core/graph/graph.hpp>

namespace WAYMARK_EXPORT waymark {

/// Derive from it and add kTag, value_names() and, for a report with units, value_units():
///   struct VertexClockBias : ScalarState {
///     static constexpr std::string_view kTag = "VERTEX_CLOCK_BIAS";
///     ...
///   };
/// Errors of edges take the number as a scalar T.
struct ScalarState {
  static constexpr int kValueSize = 1;
  static constexpr int kTangentSize = 1;
  static constexpr bool kLinearChart = true;

  template <typename T>
  static T at(const double* value, const T* delta) {
    return delta[0] + T(value[0]);
  }
  static void retract(double* value, const double* delta) { value[0] += delta[0]; }
  static void local(const double* from, const double* to, double* delta) { delta[0] = to[0] - from[0]; }
};

/// Ties a vertex of plain numbers (a ScalarState, a point or an offset in the plane) to known ones with an
/// EDGE_GAUSSIAN_PRIOR. @param known as many as the vertex has @param sigma of each, in its unit, above 0
inline void add_prior(Graph& graph, VertexIndex state, std::span<const double> known, double sigma) {
  const VertexType& type = graph.vertex_type(state);
  std::vector<double> fields(known.begin(), known.end());
  fields.resize(static_cast<std::size_t>(type.value_size + type.tangent_size), 0.0);
  graph.add_edge(gaussian_prior_type(), std::array{state}, fields,
                 Eigen::MatrixXd::Identity(type.tangent_size, type.tangent_size) / (sigma * sigma));
}

/// Ties such a vertex to 0. @param sigma as for add_prior()
inline void add_prior_about_zero(Graph& graph, VertexIndex state, double sigma) {
  const std::vector<double> zeros(static_cast<std::size_t>(graph.vertex_type(state).value_size), 0.0);
  add_prior(graph, state, zeros, sigma);
}

}  // namespace waymark
