/// What the estimator says: poses, poses at the end of the lag, and events.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include <Eigen/Core>

#include <waymark/core/drive/stamp.hpp>

namespace waymark::live {

/// How much the poses are worth. tools/live/README.md has the rules.
enum class State {
  waiting,         ///< there is no odometry or no fix yet
  aligning,        ///< the place is that of the fixes; the heading is not known yet
  tracking,        ///< fixes arrive and are used
  dead_reckoning,  ///< the last used fix is older than it usually is
  degraded,        ///< the radius of 95 % is larger than the stated limit
  lost             ///< there is no odometry, or no solution: the pose is no longer kept up
};

/// "waiting", "aligning", "tracking", "dead_reckoning", "degraded", "lost".
[[nodiscard]] std::string_view to_string(State state);

/// The newest pose. There is one for each sample of the odometry, and one more after each solution.
struct LivePose {
  Stamp stamp;
  /// x, y in m of the frame, heading in rad, counter-clockwise from grid east: the best estimate. It steps
  /// when a fix corrects it.
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of x, y, heading in these axes
  /// The same pose without the steps: the sum of the motions. It drifts, and keeps its frame until `resets`
  /// changes.
  Eigen::Vector3d smooth = Eigen::Vector3d::Zero();
  double speed_mps = 0;       ///< ground metres per second, by the odometry
  double yaw_rate_radps = 0;  ///< by the odometry
  State state = State::waiting;
  bool heading_known = false;        ///< false: heading and its variance mean nothing
  bool corrected = false;            ///< a solution was made for it
  std::uint32_t resets = 0;          ///< how often the estimate began anew
  double fix_age_s = 0;              ///< since the last used fix
  std::optional<double> height_m{};  ///< above the ellipsoid, if a sensor estimates it
  double radius95_m = 0;             ///< of the circle that holds the place with 95 %
};

/// A pose that leaves the window: its last estimate, with all that was measured up to a lag later.
struct SettledPose {
  Stamp stamp;
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();  ///< as LivePose::pose
  std::uint32_t resets = 0;
};

/// Something that a user may want to know. Kinds are words of a fixed list: tools/live/README.md.
struct Event {
  Stamp stamp;
  std::string kind;    ///< "state", "rejected", "late", "reset", "jump", "failure", ...
  std::string source;  ///< name of the source that it concerns; empty: none
  std::string text;    ///< one sentence
};

using Report = std::variant<LivePose, SettledPose, Event>;

}  // namespace waymark::live
