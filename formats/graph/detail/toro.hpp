/// TORO's format for plane graphs: `VERTEX2 id x y heading` and `EDGE2 from to x y heading` with
/// six numbers of a matrix in the order I_ff I_fs I_ss I_rr I_fr I_sr (f forward, s sideward, r
/// rotation). TORO itself writes VERTEX and EDGE, and reads both spellings. GTSAM has the same
/// tags, and also ODOMETRY for EDGE2; its matrix is a covariance in the same order.
#pragma once

#include <array>
#include <string_view>

#include <Eigen/Core>

#include <waymark/formats/graph/graph_format.hpp>
#include <waymark/formats/text/detail/line_scanner.hpp>
#include <waymark/formats/text/detail/text_builder.hpp>

namespace waymark::formats {

/// Row and column of each of the six numbers.
inline constexpr std::array<std::array<int, 2>, 6> kToroOrder = {
    {{0, 0}, {0, 1}, {1, 1}, {2, 2}, {0, 2}, {1, 2}}};

/// Returns our tag for a word of a TORO file (`format` toro) or a GTSAM file (covariance), or
/// nothing if there is none.
[[nodiscard]] std::string_view own_tag_of_toro(std::string_view word, GraphFormat format);

/// Reads the next six numbers of a line.
/// @param matrix 3 x 3
/// @throws InputError
void read_toro_matrix(LineScanner& line, std::string_view tag, GraphFormat format, Eigen::MatrixXd& matrix);

/// @param matrix 3 x 3, symmetric
void write_toro_matrix(const Eigen::MatrixXd& matrix, TextBuilder& out);

}  // namespace waymark::formats
