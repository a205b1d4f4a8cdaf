#include <waymark/types_se2/edge_se2.hpp>

namespace waymark {

void EdgeSe2::prepare() {
  turned = rotate_back(measured[2], Eigen::Vector2d(measured.head<2>()));
}

void EdgeSe2Log::prepare() {
  relative = RelativeMeasurement(Pose2<double>(measured[0], measured[1], measured[2]));
}

void EdgePriorSe2::linearize(const Pose2<double>& pose, ErrorVector<3>& e,
                             JacobianMatrix<3, 3>& by_pose) const {
  const auto [s, c] = sin_cos(measured[2]);
  const double dx = pose.position[0] - measured[0];
  const double dy = pose.position[1] - measured[1];
  e << c * dx + s * dy, c * dy - s * dx, wrap_angle(pose.heading - measured[2]);
  by_pose << c, s, 0, -s, c, 0, 0, 0, 1;
}

void EdgeSe2Xy::linearize(const Pose2<double>& pose, const Vector2<double>& landmark, ErrorVector<2>& e,
                          JacobianMatrix<2, 3>& by_pose, JacobianMatrix<2, 2>& by_landmark) const {
  const auto [s, c] = sin_cos(pose.heading);
  const double dx = landmark[0] - pose.position[0];
  const double dy = landmark[1] - pose.position[1];
  const double seen_x = c * dx + s * dy;
  const double seen_y = c * dy - s * dx;
  e << seen_x - measured[0], seen_y - measured[1];
  by_pose << -c, -s, seen_y, s, -c, -seen_x;
  by_landmark << c, s, -s, c;
}

template class EdgeBatch<EdgeSe2>;
template class EdgeBatch<EdgeSe2Log>;
template class EdgeBatch<EdgePriorSe2>;
template class EdgeBatch<EdgeSe2Xy>;

}  // namespace waymark
