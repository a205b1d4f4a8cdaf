#include <waymark/formats/graph/detail/toro.hpp>

namespace waymark::formats {

std::string_view own_tag_of_toro(std::string_view word, GraphFormat format) {
  if (word == "VERTEX2" || word == "VERTEX") return "VERTEX_SE2";
  if (word == "EDGE2" || word == "EDGE") return "EDGE_SE2";
  if (word == "ODOMETRY" && format == GraphFormat::covariance) return "EDGE_SE2";
  return {};
}

void read_toro_matrix(LineScanner& line, std::string_view tag, GraphFormat format, Eigen::MatrixXd& matrix) {
  const std::string_view name = format == GraphFormat::covariance ? "covariance" : "information";
  int index = 0;
  for (const auto& [row, column] : kToroOrder) {
    matrix(row, column) = matrix(column, row) = line.number({tag, name, index++});
  }
}

void write_toro_matrix(const Eigen::MatrixXd& matrix, TextBuilder& out) {
  for (const auto& [row, column] : kToroOrder) out.number(matrix(row, column));
}

}  // namespace waymark::formats
