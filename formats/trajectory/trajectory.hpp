/// Writes trajectories as text: CSV for tables, TUM for evo and similar programs (map_formats.hpp
/// has the map formats). Also reads TUM, a common form of ground truth.
///
/// Numbers have the shortest digits that read back to the same double; stamps are exact. A number
/// that is not finite is an OutputError that names the point, and nothing is written.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/sample.hpp>
#include <waymark/core/drive/stamp.hpp>

namespace waymark::formats {

/// One pose of a trajectory with its accuracy and its fix.
struct TrajectoryPoint {
  Stamp stamp;
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();  ///< x, y [m] in the frame, heading [rad]
  std::optional<double> latitude_deg;              ///< WGS84
  std::optional<double> longitude_deg;
  /// status of the fix at this epoch ("accepted", ...); empty: no fix
  std::string status;
  std::string reason;          ///< reason for that status
  std::optional<Stamp> utc{};  ///< the same instant in POSIX nanoseconds; empty: the date is not known
  std::optional<Eigen::Matrix3d> covariance{};  ///< of x, y [m] in frame axes, heading [rad]
};

/// Returns comma-separated values (RFC 4180 with "\n" line ends) under one header line: stamp_ns,
/// x_m, y_m, heading_rad, latitude_deg, longitude_deg, sigma_x_m, sigma_y_m, sigma_heading_rad,
/// status, reason, unix_s, utc ("2006-06-01T08:16:07.04Z"). The columns are always the same; a
/// missing value is an empty field.
[[nodiscard]] std::string trajectory_csv(std::span<const TrajectoryPoint> points);

/// Returns lines "t x y z qx qy qz qw". t is in seconds with nine decimals on the time scale of the
/// trajectory, z is 0, and the quaternion is a rotation about z. Points are written in the given
/// order; evo expects them ordered by time.
[[nodiscard]] std::string trajectory_tum(std::span<const TrajectoryPoint> points);

/// Returns the same lines with Unix time, as recordings of other systems have it; stamps without a date are
/// written as they are.
[[nodiscard]] std::string trajectory_tum_unix(std::span<const TrajectoryPoint> points);

/// Returns KITTI's form of poses: for each point the first three rows of its 4 x 4 matrix, row by row, 12 numbers
/// in a line. x and y are those of the frame and z is up, which KITTI's camera frame has otherwise; evo compares
/// trajectories in any frame. The form has no stamps.
[[nodiscard]] std::string trajectory_kitti(std::span<const TrajectoryPoint> points);

/// Reads a TUM trajectory: eight numbers per line, separated by blanks. Empty lines and lines that
/// start with '#' are skipped. Stamps are exact to the nanosecond. z is dropped. The heading is the
/// yaw of the quaternion (norm within 1 % of 1), in (-pi, pi]. Poses are in the order of the file.
/// @param text the whole file
/// @param name name of the file, for messages
/// @throws InputError "truth.tum:3:14: TUM: expected a number for 'y', got 'abc'" and the like;
/// also if no pose is found
[[nodiscard]] std::vector<StampedPose> read_tum(std::string_view text, std::string_view name);

}  // namespace waymark::formats
