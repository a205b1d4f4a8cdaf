/// Writes a fused drive as messages of ROS: nav_msgs/Odometry on /waymark/odometry, and sensor_msgs/NavSatFix on
/// /waymark/fix where the place on the Earth is known.
///
/// **Odometry**: `frame_id` is "map" (x east, y north of the grid, from the origin of the frame), `child_frame_id`
/// "base_link" (the body point; x forward, y left), as REP 105 has them. z is 0. The covariance of the pose has
/// the block of x, y and yaw; z, roll and pitch are not estimated, and have the variance 1e6. Without a known
/// covariance all of it is 0. The twist is the mean motion to the next pose, in the body frame, with no
/// covariance (0). **NavSatFix**: the pose on WGS84 with its covariance; east and north of the grid stand for those
/// of the ellipsoid; the altitude is NaN.
///
/// Stamps are Unix time. Stamps without a date (a simulation's seconds) are written as they are.
///
/// A pose that is not finite, and a stamp before 1970 or after 2106, is an OutputError that names the point.
#pragma once

#include <span>
#include <string>

#include <waymark/formats/trajectory/trajectory.hpp>

namespace waymark::formats {

/// Returns an MCAP file (mcap.dev/spec, version 0) with messages in ROS 2's CDR and their definitions; without
/// chunks and index.
[[nodiscard]] std::string trajectory_mcap(std::span<const TrajectoryPoint> points);

/// Returns a bag of ROS 1, version 2.0 (wiki.ros.org/Bags/Format/2.0), with its index; not compressed.
[[nodiscard]] std::string trajectory_bag(std::span<const TrajectoryPoint> points);

}  // namespace waymark::formats
