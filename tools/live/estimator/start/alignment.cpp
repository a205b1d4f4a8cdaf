#include <waymark/tools/live/estimator/start/alignment.hpp>

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include <waymark/tools/drive/nodes/start.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::live {
namespace {

/// Returns stamps and motions of the nodes.
PlacedStretch nodes_of(const Reckoning& reckoning) {
  PlacedStretch stretch;
  for (const Reckoning::Node& node : reckoning.nodes()) stretch.stamps.push_back(node.sample.stamp);
  for (std::size_t node = 1; node < stretch.stamps.size(); ++node) {
    stretch.intervals.push_back(reckoning.motion_to_node(node));
    stretch.givers.push_back(stretch.intervals.back().bridged ? 0 : reckoning.nodes()[node].giver);
  }
  return stretch;
}

}  // namespace

bool heading_is_known(const std::deque<Fix>& fixes, const Reckoning& reckoning, const LiveSettings& live) {
  if (fixes.size() < 2) return false;
  const Reckoning::Node from = reckoning.at(fixes.front().stamp);
  const Reckoning::Node to = reckoning.at(fixes.back().stamp);
  const double reckoned_m = (to.pose - from.pose).head<2>().norm();
  const double shown_m = (fixes.back().position - fixes.front().position).norm();
  double squares = 0;
  for (const Fix& fix : fixes) squares += fix.accuracy_m() * fix.accuracy_m();
  const double sigma_m = std::max(2.0, std::sqrt(squares / static_cast<double>(fixes.size())));
  const double least_m = std::max(live.least_distance_m, std::sqrt(2.0) * sigma_m / live.heading_sigma_rad);
  return std::min(reckoned_m, shown_m) >= least_m;
}

PlacedStretch laid_along(const std::deque<Fix>& fixes, const Reckoning& reckoning,
                         const drive::FusionSettings& settings) {
  PlacedStretch stretch = nodes_of(reckoning);
  drive::Timeline timeline{stretch.stamps, stretch.intervals, {}};
  const DriveNodes nodes{timeline.stamps, {}, timeline.intervals};
  for (const Fix& fix : fixes) timeline.fix_node.push_back(nearest_node(nodes, fix.stamp, 1e9)->node);
  const std::vector<Fix> list(fixes.begin(), fixes.end());
  stretch.poses = drive::make_start(timeline, list, reckoning.standstill_mps(), settings.initial_guess).poses;
  return stretch;
}

PlacedStretch placed_at(const Eigen::Vector3d& pose, const Reckoning& reckoning) {
  PlacedStretch stretch = nodes_of(reckoning);
  const Pose2<double> first = to_pose(reckoning.nodes().front().pose);
  for (const Reckoning::Node& node : reckoning.nodes())
    stretch.poses.push_back(compose(to_pose(pose), between(first, to_pose(node.pose))).vector());
  return stretch;
}

std::optional<double> moved_since(const WarmStart& start, const Fix& fix, const LiveSettings& live) {
  const Eigen::Vector3d& pose = *start.pose;
  const Eigen::Vector2d antenna = pose.head<2>() + rotate(pose[2], fix.antenna_seen_m());
  const Eigen::Matrix2d spread =
      start.covariance.topLeftCorner<2, 2>() + 4 * fix.covariance + 25 * Eigen::Matrix2d::Identity();
  const Eigen::Vector2d off = fix.position - antenna;
  return off.dot(spread.inverse() * off) > live.absurd ? std::optional(off.norm()) : std::nullopt;
}

drive::FirstPose first_pose_of(const WarmStart& start) {
  drive::FirstPose first;
  first.position = start.pose->head<2>();
  first.heading_rad = (*start.pose)[2];
  first.sigma_m = std::sqrt(0.5 * start.covariance.topLeftCorner<2, 2>().trace());
  first.sigma_rad = std::sqrt(start.covariance(2, 2));
  return first;
}

}  // namespace waymark::live
