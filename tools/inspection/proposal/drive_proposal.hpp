/// Proposes a drive.yaml for inspected logs. The user then edits it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <waymark/tools/inspection/inspection.hpp>

namespace waymark::inspection {

/// The role of each log of a drive. Numbers are indices of the inspected logs.
struct DriveProposal {
  std::vector<std::size_t> odometry;  ///< one complete log, or parts
  /// for each of them its quantities without `time`
  std::vector<std::vector<std::string>> channels;
  bool in_parts = false;
  /// the odometry has channels from which the quantity can be computed
  bool has_speed = false, has_yaw_rate = false;
  /// complete logs of odometry beside that one, each with its quantities: other sensors, or copies
  std::vector<std::size_t> further;
  std::vector<std::vector<std::string>> further_channels;
  std::vector<std::size_t> gnss;
  std::vector<std::size_t>
      velocity;  ///< speed and course of a receiver without positions; it belongs to the first gnss
  std::vector<std::size_t> truth;
  std::vector<std::size_t> unused;
  std::vector<std::string> decisions;  ///< the decisions and their reasons, one sentence each
};

/// Chooses the role of each log. A table with positions is the truth if it has a counter-clockwise
/// heading or a name such as "truth", but never if it has the only positions. Other positions
/// belong to a receiver. Speed and yaw rate in one log are odometry; each alone is a part of
/// odometry. A channel that an earlier log gives is not used again, but a log that has both
/// is proposed as a further source. The log of a receiver gives odometry only if no other log does.
[[nodiscard]] DriveProposal propose_drive(const std::vector<LogInspection>& logs);

/// Returns a drive.yaml that can be parsed as it is. `# CHECK` marks values that were guessed.
/// @param path where it will be written. Logs in its folder, below it or beside it are named
/// relative to it, others absolutely
[[nodiscard]] std::string drive_yaml(const DriveProposal& proposal, const std::vector<LogInspection>& logs,
                                     const std::string& path);

/// Returns all keys as comments, if there are no logs.
[[nodiscard]] std::string drive_template();

}  // namespace waymark::inspection
