#include <waymark/types_se2/g2o_edges.hpp>

namespace waymark {

void EdgePriorSe2Xy::linearize(const Pose2<double>& pose, ErrorVector<2>& e,
                               JacobianMatrix<2, 3>& by_pose) const {
  e = pose.position - measured;
  by_pose << 1, 0, 0, 0, 1, 0;
}

void EdgePriorXy::linearize(const Vector2<double>& point, ErrorVector<2>& e,
                            JacobianMatrix<2, 2>& by_point) const {
  e = point - measured;
  by_point.setIdentity();
}

// With d = p_point - p and r = |d|, the direction of d turns by (d.x dy - d.y dx) / r^2.
void EdgeBearingSe2Xy::linearize(const Pose2<double>& pose, const Vector2<double>& point, ErrorVector<1>& e,
                                 JacobianMatrix<1, 3>& by_pose, JacobianMatrix<1, 2>& by_point) const {
  e = error<double>(pose, point);
  const Vector2<double> d = point - pose.position;
  const double squared = d.squaredNorm();
  if (!(squared > 0)) {
    by_pose.setZero();
    by_point.setZero();
    return;
  }
  by_point << -d[1] / squared, d[0] / squared;
  by_pose << d[1] / squared, -d[0] / squared, -1;
}

// With q = R^T (p_point - p), e = R_O^T (q - t_O) - z, and the heading turns q by (q.y, -q.x).
void EdgeSe2PointXyOffset::linearize(const Pose2<double>& pose, const Vector2<double>& point,
                                     ErrorVector<2>& e, JacobianMatrix<2, 3>& by_pose,
                                     JacobianMatrix<2, 2>& by_point) const {
  const Vector2<double> q = rotate_back(pose.heading, Vector2<double>(point - pose.position));
  e = rotate_back(offset[2], Vector2<double>(q - offset.head<2>())) - measured;
  const auto [s, c] = sin_cos(pose.heading + offset[2]);
  by_point << c, s, -s, c;
  by_pose.leftCols<2>() = -by_point;
  by_pose.col(2) = rotate_back(offset[2], Vector2<double>(q[1], -q[0]));
}

template class EdgeBatch<EdgePriorSe2Xy>;
template class EdgeBatch<EdgePriorXy>;
template class EdgeBatch<EdgeBearingSe2Xy>;
template class EdgeBatch<EdgeSe2Offset>;
template class EdgeBatch<EdgeSe2PointXyOffset>;

}  // namespace waymark
