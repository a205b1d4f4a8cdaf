#include <waymark/plugins/twist/detail/sensor_way.hpp>

namespace waymark::plugins::twist {
namespace {

/// Returns the derivative of the place of exp(way) by a bias that turns `way` by -bias * seconds.
Eigen::Vector2d place_by_bias(const Eigen::Vector3d& way, double seconds) {
  const Eigen::Vector3d moved = se2_right_jacobian(way).col(2) * -seconds;
  return rotate(way[2], Eigen::Vector2d(moved.head<2>()));
}

}  // namespace

// The covariance of a piece is that of an error of its twist that is constant over the piece.
void SensorWay::add(const Eigen::Vector3d& twist, const Eigen::Vector3d& density, double seconds) {
  const Eigen::Vector3d way = seconds * twist;
  const Pose2<double> piece = se2_exp(way);
  // the derivative of the piece's place by the heading before it
  const Eigen::Vector2d across(-piece.position[1], piece.position[0]);
  place_by_bias_ += rotate(motion_.heading, Eigen::Vector2d(place_by_bias(way, seconds) - seconds_ * across));
  const Eigen::Matrix3d carried = se2_adjoint(inverse(piece));
  const Eigen::Matrix3d jacobian = se2_right_jacobian(way);
  const Eigen::Vector3d variances = seconds * density;
  covariance_ =
      (carried * covariance_ * carried.transpose() + jacobian * variances.asDiagonal() * jacobian.transpose())
          .eval();
  motion_ = compose(motion_, piece);
  seconds_ += seconds;
}

Eigen::Vector2d SensorWay::bend() const {
  return place_by_bias_ - place_by_bias(mean_way(), seconds_);
}

}  // namespace waymark::plugins::twist
