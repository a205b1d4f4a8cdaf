/// Statements of the .graph format that stand for themselves: no other line is needed to read them.
#pragma once

#include <Eigen/Core>

#include <waymark/core/drive/frame.hpp>
#include <waymark/core/drive/sample.hpp>
#include <waymark/core/graph/graph.hpp>
#include <waymark/formats/text/detail/line_scanner.hpp>

namespace waymark::formats {

/// Smallest eigenvalue not below -1e-9 of the largest; zeros are legal (no information on an axis).
[[nodiscard]] bool is_positive_semidefinite(const Eigen::MatrixXd& matrix);

/// The next word as the id of a vertex of the graph. @throws InputError where it is none
[[nodiscard]] VertexIndex read_vertex_id(LineScanner& line, const Graph& graph, std::string_view tag);

/// The rest of a FRAME line. @throws InputError
[[nodiscard]] Frame read_frame(LineScanner& line);

/// The rest of a GNSS line; whether its vertex exists is not known here. @throws InputError
[[nodiscard]] Fix read_fix(LineScanner& line);

}  // namespace waymark::formats
