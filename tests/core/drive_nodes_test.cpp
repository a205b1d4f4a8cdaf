// The motion of the odometry between the nodes of a drive: speed and yaw rate are linear there.
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/core/drive/modeling.hpp>

namespace drive_nodes_test {

using namespace waymark;

namespace {

/// A second from 2 to 4 m/s and 0 to 0.2 rad/s, then half a second from 4 to 3 m/s, straight on.
struct Drive {
  std::vector<Stamp> stamps = {Stamp::from_seconds(10), Stamp::from_seconds(11), Stamp::from_seconds(11.5)};
  std::vector<Interval> intervals = {
      {.speed_mps = 3, .yaw_rate_radps = 0.1, .dt_s = 1, .speed_change_mps = 2, .yaw_rate_change_radps = 0.2},
      {.speed_mps = 3.5, .yaw_rate_radps = 0, .dt_s = 0.5, .speed_change_mps = -1}};

  [[nodiscard]] MotionFromNode from(std::size_t node, double ahead_s) const {
    DriveNodes nodes;
    nodes.stamps = stamps;
    nodes.intervals = intervals;
    return motion_from_node(nodes, {node, ahead_s});
  }
};

}  // namespace

TEST_CASE("drive nodes: the way to a moment is the integral of rates that are linear in the interval") {
  const Drive drive;
  // After the first node the speed is 2 + 2 t and the yaw rate 0.2 t.
  const MotionFromNode after = drive.from(0, 0.3);
  CHECK(after.way.isApprox(Eigen::Vector3d(2 * 0.3 + 0.09, 0, 0.1 * 0.09)));
  CHECK(after.twist.isApprox(Eigen::Vector3d(2.6, 0, 0.06)));
  // Back from the second one: the integral from 0.6 to 1 s.
  const MotionFromNode before = drive.from(1, -0.4);
  CHECK(before.way.isApprox(-Eigen::Vector3d(2 * 0.4 + 1 - 0.36, 0, 0.1 * (1 - 0.36))));
  CHECK(before.twist.isApprox(Eigen::Vector3d(3.2, 0, 0.12)));
  // From both nodes to one moment it is the whole way.
  CHECK((drive.from(0, 0.6).way - before.way).isApprox(Eigen::Vector3d(3, 0, 0.1)));
}

TEST_CASE("drive nodes: at a node the interval before counts, beyond the ends the last rate stays") {
  const Drive drive;
  CHECK(drive.from(1, 0).way.isZero());
  CHECK(drive.from(1, 0).twist.isApprox(Eigen::Vector3d(4, 0, 0.2)));
  CHECK(drive.from(0, -0.5).way.isApprox(Eigen::Vector3d(-1, 0, 0)));
  CHECK(drive.from(2, 0.2).way.isApprox(Eigen::Vector3d(0.6, 0, 0)));
  CHECK(drive.from(2, 0.2).twist.isApprox(Eigen::Vector3d(3, 0, 0)));
}

}  // namespace drive_nodes_test
