#include <waymark/types_se2/edge_gnss.hpp>

namespace waymark {

void EdgeGnssPosition::linearize(const Pose2<double>& from, const Pose2<double>& to, ErrorVector<2>& e,
                                 JacobianMatrix<2, 3>& by_from, JacobianMatrix<2, 3>& by_to) const {
  const auto [s, c] = sin_cos(from.heading);
  const auto [to_s, to_c] = sin_cos(to.heading);
  const double arm_x = to_c * antenna[0] - to_s * antenna[1];
  const double arm_y = to_s * antenna[0] + to_c * antenna[1];
  const double dx = to.position[0] + arm_x - from.position[0];
  const double dy = to.position[1] + arm_y - from.position[1];
  const double seen_x = c * dx + s * dy;
  const double seen_y = c * dy - s * dx;
  e << seen_x - measured[0], seen_y - measured[1];
  by_from << -c, -s, seen_y, s, -c, -seen_x;
  by_to << c, s, s * arm_x - c * arm_y, -s, c, c * arm_x + s * arm_y;
}

template class EdgeBatch<EdgeGnssPosition>;
template class EdgeBatch<EdgeGnssPositionLate>;

}  // namespace waymark
