#include <waymark/formats/graph/detail/foreign_edge.hpp>

#include <Eigen/Geometry>

namespace waymark::formats {
namespace {

Eigen::Matrix2d rotation(double angle) {
  return Eigen::Rotation2Dd(angle).toRotationMatrix();
}

/// The difference of two numbers that rounding may cause.
constexpr double kRounding = 1e-12;

}  // namespace

void say_position_as_pose(ForeignEdge& edge) {
  const std::vector<double> given = edge.fields;  // measured x y, antenna x y
  const bool lever = given[2] != 0 || given[3] != 0;
  edge.tag = lever ? "EDGE_SE2_OFFSET" : "EDGE_SE2";
  edge.fields = {given[0], given[1], 0};
  if (lever) edge.fields.insert(edge.fields.end(), {0, 0, 0, given[2], given[3], 0});
  edge.information.conservativeResizeLike(Eigen::MatrixXd::Zero(3, 3));
}

void say_sensor_as_body(ForeignEdge& edge) {
  const std::vector<double> given = edge.fields;  // measured x y, offset x y heading
  const Eigen::Matrix2d r = rotation(given[4]);
  const Eigen::Vector2d seen = Eigen::Vector2d(given[2], given[3]) + r * Eigen::Vector2d(given[0], given[1]);
  edge.tag = "EDGE_SE2_XY";
  edge.fields = {seen[0], seen[1]};
  edge.information = Eigen::MatrixXd(r * edge.information * r.transpose());
}

std::optional<Refusal> say_for_example(ForeignEdge& edge) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = rotation(edge.fields[2]);
  const Eigen::Matrix3d turned = turn * edge.information * turn.transpose();
  const Eigen::Matrix3d diagonal = turned.diagonal().asDiagonal();
  const double rounding = kRounding * diagonal.maxCoeff();
  if ((turned - diagonal).cwiseAbs().maxCoeff() > rounding) {
    return Refusal{
        "weighs an error by L if the information is L L^T: an edge whose axes are correlated, as "
        "seen from the first pose, would have another minimum",
        "write --format g2o for readers that weigh by L^T"};
  }
  if (!(diagonal(0, 0) > 0 && diagonal(1, 1) > 0)) {
    return Refusal{"cannot factorise an information matrix that is zero in x or y", "write --format g2o"};
  }
  // If turning changed only the last digits, the numbers stay as they were.
  const bool same = (diagonal - edge.information).cwiseAbs().maxCoeff() <= rounding;
  const Eigen::Vector3d said =
      same ? Eigen::Vector3d(edge.information.diagonal()) : Eigen::Vector3d(diagonal.diagonal());
  edge.information = said.asDiagonal();
  return std::nullopt;
}

}  // namespace waymark::formats
