/// A drive on a winding way with exact readings, for tests that damage them.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include <waymark/core/drive/sample.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::testing {

struct WindingScene {
  std::vector<OdometrySample> odometry;  ///< 10 Hz
  std::vector<Fix> fixes;                ///< 1 Hz, exact
};

/// Follows a speed [m/s] and a yaw rate [rad/s] over time [s] from the origin.
inline WindingScene winding_scene(double length_s, const std::function<double(double)>& speed,
                                  const std::function<double(double)>& yaw_rate) {
  WindingScene result;
  Pose2<double> pose;
  for (int i = 0; i <= static_cast<int>(std::lround(10 * length_s)); ++i) {
    const double t = 0.1 * i;
    result.odometry.push_back(
        {.stamp = Stamp::from_seconds(t), .speed_mps = speed(t), .yaw_rate_radps = yaw_rate(t)});
    if (i % 10 == 0) {
      Fix fix;
      fix.stamp = Stamp::from_seconds(t);
      fix.position = pose.position;
      result.fixes.push_back(fix);
    }
    pose = compose(pose, se2_exp<double>(Eigen::Vector3d(0.1 * speed(t), 0, 0.1 * yaw_rate(t))));
  }
  return result;
}

}  // namespace waymark::testing
