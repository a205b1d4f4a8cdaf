/// Rewrites edges for other programs. The rewritten edge has the same chi2 at all values of
/// its vertices.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/graph/vertex.hpp>

namespace waymark::formats {

/// One edge in the form that a file for another program needs.
struct ForeignEdge {
  std::string_view tag;  ///< as our own formats call it
  std::vector<VertexIndex> vertices;
  std::vector<double> fields;
  Eigen::MatrixXd information;
};

/// Turns EDGE_GNSS_POSITION into EDGE_SE2 with heading 0 and no information on the heading. With a
/// lever arm it becomes EDGE_SE2_OFFSET, and the antenna is a sensor at the second pose: the
/// translation of D = Z^-1 X_i^-1 (X_j O) is R_i^T (p_j + R_j a - p_i) - z.
void say_position_as_pose(ForeignEdge& edge);

/// Turns EDGE_SE2_POINTXY_OFFSET into EDGE_SE2_XY. The body itself would have measured t + R z,
/// with R Omega R^T.
void say_sensor_as_body(ForeignEdge& edge);

/// Why an edge cannot be expressed, and the remedy.
struct Refusal {
  const char* why;
  const char* remedy;
};

/// Rewrites EDGE_SE2 for the example of Ceres (pose_graph_2d.cc, pose_graph_2d_error_term.h).
/// Its error is e = (R_i^T (p_j - p_i) - t_Z, wrapped heading): that of EDGE_SE2, turned by the
/// measured heading. So its information is T Omega T^T with T = (R_Z, 1). The example minimises |L
/// e|^2, where L is the lower Cholesky factor of the matrix in the file. This equals e^T Omega e
/// only if the matrix is diagonal and no entry but the last is zero (the factorisation ends at a
/// zero). All other matrices are refused.
[[nodiscard]] std::optional<Refusal> say_for_example(ForeignEdge& edge);

}  // namespace waymark::formats
