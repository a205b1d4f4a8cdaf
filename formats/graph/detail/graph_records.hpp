/// Statements of the .graph format that can be read without any other line.
#pragma once

#include <Eigen/Core>

#include <waymark/core/drive/frame.hpp>
#include <waymark/core/drive/sample.hpp>
#include <waymark/core/graph/graph.hpp>
#include <waymark/formats/text/detail/line_scanner.hpp>

namespace waymark::formats {

/// What is said of an information matrix that is not positive semidefinite.
inline constexpr std::string_view kIndefinite =
    "the information matrix is indefinite (an eigenvalue below -1e-9 of the largest)";

/// Reads the next word as the id of a vertex of the graph. @throws InputError if it is none
[[nodiscard]] VertexIndex read_vertex_id(LineScanner& line, const Graph& graph, std::string_view tag);

/// Reads the rest of a FRAME line. @throws InputError
[[nodiscard]] Frame read_frame(LineScanner& line);

/// Reads the rest of a GNSS line. It does not check that the vertex exists. @throws InputError
[[nodiscard]] Fix read_fix(LineScanner& line);

}  // namespace waymark::formats
