/// Edges in other words with the same chi2 at all values of their vertices.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/graph/vertex.hpp>

namespace waymark::formats {

/// One edge as a file for another program has it.
struct ForeignEdge {
  std::string_view tag;  ///< in our words
  std::vector<VertexIndex> vertices;
  std::vector<double> fields;
  Eigen::MatrixXd information;
};

/// EDGE_GNSS_POSITION as EDGE_SE2 with heading 0 and no information on it; with a lever arm as
/// EDGE_SE2_OFFSET, the antenna a sensor at the second pose: D = Z^-1 X_i^-1 (X_j O) has the translation
/// R_i^T (p_j + R_j a - p_i) - z.
void say_position_as_pose(ForeignEdge& edge);

/// EDGE_SE2_POINTXY_OFFSET as EDGE_SE2_XY: the body itself would have measured t + R z, with R Omega R^T.
void say_sensor_as_body(ForeignEdge& edge);

/// Why an edge cannot be said, and what to do instead.
struct Refusal {
  const char* why;
  const char* remedy;
};

/// EDGE_SE2 for Ceres' example (pose_graph_2d.cc, pose_graph_2d_error_term.h). Its error is e = (R_i^T (p_j -
/// p_i) - t_Z, wrapped heading), EDGE_SE2's turned by the measured heading, so its information is T Omega T^T
/// with T = (R_Z, 1). It minimises |L e|^2 with the lower Cholesky factor L of the file's matrix: that is e^T
/// Omega e for a diagonal matrix with no zero but the last entry (the factorisation ends at a zero), and else
/// refused.
[[nodiscard]] std::optional<Refusal> say_for_example(ForeignEdge& edge);

}  // namespace waymark::formats
