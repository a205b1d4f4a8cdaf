/// Compares the Jacobians of edges with derivatives nobody wrote by hand.
#pragma once

#include <optional>
#include <string>

#include <waymark/core/graph/graph.hpp>

namespace waymark {

/// A Jacobian by differences of the error.
struct NumericJacobian {
  Eigen::MatrixXd jacobian;  ///< error dimension x tangent size
  double tolerance = 0;      ///< what it is good to, absolute; rounding grows as the step gets shorter
};

/// The derivative of an edge's error by the tangent of its vertex k, by differences of fourth order with the
/// first step, from 2e-3 downwards, of which half says the same. A component that jumps by a turn did so only
/// because angles wrap. Empty where no step does: there is no derivative, as of a bearing at the landmark.
[[nodiscard]] std::optional<NumericJacobian> numeric_jacobian(const Graph& graph, std::size_t batch,
                                                              std::size_t edge, std::size_t k);

/// The largest disagreement found.
struct GradientCheck {
  std::size_t edges = 0;   ///< looked at
  std::size_t judged = 0;  ///< Jacobians that differences could say something of
  double error = 0;        ///< |given - reference| / (1 + |reference|), largest over all entries that
                           ///< differences can judge
  std::size_t edge = 0;    ///< where
  std::size_t vertex = 0;  ///< which of the edge's vertices
  int row = 0;
  int column = 0;
  double given = 0;
  double reference = 0;
};

/// A disagreement beyond this is a wrong Jacobian: differences are good to 1e-9 of the error's size mostly.
inline constexpr double kGradientTolerance = 1e-5;

/// Compares up to `most` edges of a batch (evenly spread) with differences of the error at the present
/// values.
[[nodiscard]] GradientCheck check_gradients(const Graph& graph, std::size_t batch, std::size_t most);

/// "EDGE_X number 3: Jacobian by vertex 2 (VERTEX_SE2 17), row 0, column 2 (heading): given 1.5, differences
/// of the error say 0.5".
[[nodiscard]] std::string describe(const Graph& graph, std::size_t batch, const GradientCheck& check);

}  // namespace waymark
