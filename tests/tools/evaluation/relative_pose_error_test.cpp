// Relative pose error, against values that can be told by hand.
#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/evaluation/numbers/constant_offset.hpp>
#include <waymark/tools/evaluation/numbers/relative_pose_error.hpp>

namespace relative_pose_error_test {

using namespace waymark;
using namespace waymark::evaluation;

namespace {

using Poses = std::vector<Eigen::Vector3d>;

/// Along the x axis, a pose every metre, scaled and turned.
Poses straight(int n, double scale, double turned) {
  Poses poses;
  for (int i = 0; i < n; ++i)
    poses.emplace_back(scale * i * std::cos(turned), scale * i * std::sin(turned), turned);
  return poses;
}

}  // namespace

TEST_CASE("relative pose error: an estimate that is moved and turned as a whole has none") {
  Poses estimated = straight(101, 1, 0.7);
  for (Eigen::Vector3d& pose : estimated) pose.head<2>() += Eigen::Vector2d(40, -3);
  const RelativePoseError error = relative_pose_error(straight(101, 1, 0), estimated, 10);
  CHECK(error.translation_m.count == 9);  // 10 to 20 m, ..., 90 to 100 m, as evo counts
  CHECK(error.translation_m.max_abs == Approx(0).margin(1e-12));
  CHECK(error.rotation_rad.max_abs == Approx(0).margin(1e-12));
}

TEST_CASE("relative pose error: a scale of 1 % is 1 m in 100 m") {
  const RelativePoseError error = relative_pose_error(straight(1001, 1, 0), straight(1001, 1.01, 0), 100);
  CHECK(error.translation_m.count == 9);
  CHECK(error.translation_m.rms == Approx(1));
  CHECK(error.rotation_rad.rms == Approx(0).margin(1e-12));
}

TEST_CASE(
    "relative pose error: a heading that drifts is a rotation, and a drive that is too short has no pair") {
  const Poses truth = straight(41, 1, 0);
  Poses estimated = truth;
  for (std::size_t i = 0; i < estimated.size(); ++i) estimated[i][2] = 0.001 * static_cast<double>(i);
  CHECK(relative_pose_error(truth, estimated, 10).rotation_rad.mean == Approx(0.01));
  CHECK(relative_pose_error(truth, estimated, 100).translation_m.count == 0);
  CHECK_THROWS_AS(relative_pose_error(truth, straight(3, 1, 0), 10), UsageError);
}

TEST_CASE("constant offset: that of the vehicle is taken out, whatever its direction") {
  // 2 m ahead and 1 m to the left of the truth, eastwards and then northwards.
  const std::vector<Eigen::Vector2d> offsets{{2, 1}, {-1, 2}, {2, 1}, {0, 9}};
  const std::vector<std::optional<double>> directions{0.0, M_PI / 2, 0.0, std::nullopt};
  const OffsetTakenOut rest = without_constant_offset(offsets, directions);
  CHECK(rest.along_m == Approx(2));
  CHECK(rest.cross_m == Approx(1));
  CHECK(rest.rest.count == 3);
  CHECK(rest.rest.rmse_m == Approx(0).margin(1e-12));
  CHECK(rest.rest.accuracy_m == Approx(0).margin(1e-12));
}

}  // namespace relative_pose_error_test
