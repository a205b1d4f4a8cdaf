#include <waymark/types_se2/se2.hpp>

namespace waymark {

// With X = (p, theta): Ad = [R, (p_y, -p_x)^T; 0 0 1] for twists ordered (rho, theta).
Eigen::Matrix3d se2_adjoint(const Pose2<double>& pose) {
  const double c = std::cos(pose.heading);
  const double s = std::sin(pose.heading);
  Eigen::Matrix3d adjoint;
  adjoint << c, -s, pose.position[1], s, c, -pose.position[0], 0, 0, 1;
  return adjoint;
}

namespace {

/// (theta - sin theta) / theta^2.
double sine_remainder(double theta) {
  if (detail::is_small(theta)) return theta * (1.0 / 6 - theta * theta * (1.0 / 120 - theta * theta / 5040));
  return (theta - std::sin(theta)) / (theta * theta);
}

/// (1 - cos theta) / theta^2.
double cosine_remainder(double theta) {
  if (detail::is_small(theta)) return 0.5 - theta * theta * (1.0 / 24 - theta * theta / 720);
  return detail::one_minus_cos_over(theta) / theta;
}

}  // namespace

// Jr(xi) = [V(-theta), c; 0 1]. Equation (163) of Sola et al., "A micro Lie theory for state
// estimation in robotics".
Eigen::Matrix3d se2_right_jacobian(const Eigen::Vector3d& xi) {
  const double theta = xi[2];
  const double a = detail::sinc(theta);
  const double b = detail::one_minus_cos_over(theta);
  const double p = sine_remainder(theta);
  const double q = cosine_remainder(theta);
  Eigen::Matrix3d jacobian;
  jacobian << a, b, p * xi[0] - q * xi[1],  //
      -b, a, q * xi[0] + p * xi[1],         //
      0, 0, 1;
  return jacobian;
}

// The upper left block is V(-theta)^-1 = [h, -theta/2; theta/2, h]; the inverse of [A, c; 0 1] is
// [A^-1, -A^-1 c; 0 1].
Eigen::Matrix3d se2_right_jacobian_inverse(const Eigen::Vector3d& xi) {
  const double h = detail::half_cot(xi[2]);
  const double half = 0.5 * xi[2];
  const Eigen::Vector2d c = se2_right_jacobian(xi).topRightCorner<2, 1>();
  Eigen::Matrix3d inverse;
  inverse << h, -half, -(h * c[0] - half * c[1]),  //
      half, h, -(half * c[0] + h * c[1]),          //
      0, 0, 1;
  return inverse;
}

}  // namespace waymark
