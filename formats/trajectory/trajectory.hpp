/// Trajectories out, as text: CSV for tables, TUM for evo and its kin (maps: map_formats.hpp); and TUM in,
/// for truth given so.
///
/// Numbers are written with the shortest digits that read back to the same double, stamps exactly. A number
/// that is not finite is an OutputError that names the point: nothing is written.
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

/// One pose of a trajectory with what is known about it.
struct TrajectoryPoint {
  Stamp stamp;
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();  ///< x, y [m] in the frame, heading [rad]
  std::optional<double> latitude_deg;              ///< WGS84
  std::optional<double> longitude_deg;
  std::optional<Eigen::Vector3d> sigma;  ///< of x, y [m], heading [rad]
  std::string status;                    ///< of the fix at this epoch ("accepted", ...); empty: no fix
  std::string reason;                    ///< of that status
};

/// Comma-separated values (RFC 4180 with "\n" line ends) under one header line: stamp_ns, x_m, y_m,
/// heading_rad, latitude_deg, longitude_deg, sigma_x_m, sigma_y_m, sigma_heading_rad, status, reason. The
/// columns are always the same; what a point lacks is an empty field.
[[nodiscard]] std::string trajectory_csv(std::span<const TrajectoryPoint> points);

/// "t x y z qx qy qz qw" a line, t in seconds with nine decimals on the trajectory's own time scale, z = 0,
/// the quaternion a turn about z. Points are written as given: evo expects them in order of time.
[[nodiscard]] std::string trajectory_tum(std::span<const TrajectoryPoint> points);

/// Reads a TUM trajectory: eight numbers a line, separated by blanks; lines that start with '#' and empty
/// ones are skipped. Stamps are exact to the nanosecond. z is dropped; heading is the yaw of the quaternion
/// (norm within 1 % of 1), in (-pi, pi]. Poses come in the order of the file.
/// @param text  the whole file.
/// @param name  of the file, for messages.
/// @throws InputError "truth.tum:3:14: TUM: expected a number for 'y', got 'abc'" and the like; also where no
/// pose is found.
[[nodiscard]] std::vector<StampedPose> read_tum(std::string_view text, std::string_view name);

}  // namespace waymark::formats
