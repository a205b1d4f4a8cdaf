#include <waymark/types_se2/edge_se2.hpp>

namespace waymark {

void EdgeSe2::linearize(const Pose2<double>& from, const Pose2<double>& to, ErrorVector<3>& e,
                        JacobianMatrix<3, 3>& by_from, JacobianMatrix<3, 3>& by_to) const {
  // With a = theta_from + z.heading: e_t = R(a)^T (p_to - p_from) - R(z.heading)^T z.t.
  const double a = from.heading + measured[2];
  const double c = std::cos(a);
  const double s = std::sin(a);
  const double dx = to.position[0] - from.position[0];
  const double dy = to.position[1] - from.position[1];
  const double turned_x = c * dx + s * dy;
  const double turned_y = c * dy - s * dx;
  const Eigen::Vector2d z = rotate_back(measured[2], Eigen::Vector2d(measured.head<2>()));
  e << turned_x - z[0], turned_y - z[1], wrap_angle(to.heading - a);
  by_from << -c, -s, turned_y, s, -c, -turned_x, 0, 0, -1;
  by_to << c, s, 0, -s, c, 0, 0, 0, 1;
}

// With D = Z^-1 X_from^-1 X_to and e = log(D): moving X_to in world axes by (dp, dtheta) is a body-frame
// motion (R_to^T dp, dtheta), so de = Jr^-1(e) of it; moving X_from likewise enters through -Ad(X_to^-1
// X_from).
void linearize_log_error(const Pose2<double>& measured, const Pose2<double>& from, const Pose2<double>& to,
                         ErrorVector<3>& e, JacobianMatrix<3, 3>& by_from, JacobianMatrix<3, 3>& by_to) {
  e = se2_log(between(measured, between(from, to)));
  const Eigen::Matrix3d inverse = se2_right_jacobian_inverse(e);
  const auto to_body = [](double heading) {
    const double c = std::cos(heading);
    const double s = std::sin(heading);
    Eigen::Matrix3d rotation;
    rotation << c, s, 0, -s, c, 0, 0, 0, 1;
    return rotation;
  };
  by_to = inverse * to_body(to.heading);
  by_from = -inverse * se2_adjoint(between(to, from)) * to_body(from.heading);
}

void EdgeSe2Log::linearize(const Pose2<double>& from, const Pose2<double>& to, ErrorVector<3>& e,
                           JacobianMatrix<3, 3>& by_from, JacobianMatrix<3, 3>& by_to) const {
  linearize_log_error(Pose2<double>(measured[0], measured[1], measured[2]), from, to, e, by_from, by_to);
}

template class EdgeBatch<EdgeSe2>;
template class EdgeBatch<EdgeSe2Log>;
template class EdgeBatch<EdgeGnssPosition>;
template class EdgeBatch<EdgePriorSe2>;
template class EdgeBatch<EdgeSe2Xy>;

}  // namespace waymark
