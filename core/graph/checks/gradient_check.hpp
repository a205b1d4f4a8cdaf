/// Compares the Jacobians of edges with derivatives that nobody wrote by hand.
///
/// All functions work on copies, so several threads may call them.
#pragma once

#include <optional>
#include <string>

#include <waymark/core/base/export.hpp>
#include <waymark/core/graph/graph.hpp>

namespace WAYMARK_EXPORT waymark {

/// A Jacobian by differences of the error.
struct NumericJacobian {
  Eigen::MatrixXd jacobian;  ///< error dimension x tangent size
  double tolerance = 0;      ///< its absolute accuracy; rounding grows as the step becomes shorter
};

/// Returns the derivative of the error of an edge by the tangent of its vertex k, from differences
/// of fourth order. The step is the first one, from 2e-3 downwards, for which half the step gives
/// the same result, but for rounding, which is that of the largest coordinate. A jump of a component by a full turn comes from angle wrapping and is removed.
/// Empty if no step succeeds: there is no derivative, for example of a bearing at the landmark.
[[nodiscard]] std::optional<NumericJacobian> numeric_jacobian(const Graph& graph, std::size_t batch,
                                                              std::size_t edge, std::size_t k);

/// The largest difference found.
struct GradientCheck {
  std::size_t edges = 0;   ///< edges that were checked
  std::size_t judged = 0;  ///< Jacobians that differences could check
  /// |given - reference| / (1 + |reference|): the largest over all entries that differences
  /// can check
  double error = 0;
  std::size_t edge = 0;    ///< the edge with this error
  std::size_t vertex = 0;  ///< the vertex of the edge
  int row = 0;
  int column = 0;
  double given = 0;
  double reference = 0;
};

/// A larger error means a wrong Jacobian. Differences are usually accurate to 1e-9 of the size
/// of the error.
inline constexpr double kGradientTolerance = 1e-5;

/// Compares up to `most` edges of a batch (evenly spread) with differences of the error at the
/// present values.
[[nodiscard]] GradientCheck check_gradients(const Graph& graph, std::size_t batch, std::size_t most);

/// Returns "EDGE_X number 3: Jacobian by vertex 2 (VERTEX_SE2 17), row 0, column 2 (heading): given
/// 1.5, differences of the error give 0.5".
[[nodiscard]] std::string describe(const Graph& graph, std::size_t batch, const GradientCheck& check);

}  // namespace waymark
