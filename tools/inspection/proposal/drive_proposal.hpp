/// From logs that were looked at to a drive.yaml to edit.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <waymark/tools/inspection/inspection.hpp>

namespace waymark::inspection {

/// What the logs of a drive are for; indices of the inspected logs.
struct DriveProposal {
  std::vector<std::size_t> odometry;               ///< one whole, or parts
  std::vector<std::vector<std::string>> channels;  ///< of each of them: quantities without `time`
  bool in_parts = false;
  bool has_speed = false, has_yaw_rate = false;  ///< whether the odometry has something they are made of
  std::vector<std::size_t> gnss;
  std::vector<std::size_t>
      velocity;  ///< speed and course of a receiver without positions; belongs to the first gnss
  std::vector<std::size_t> truth;
  std::vector<std::size_t> unused;
  std::vector<std::string> decisions;  ///< what was decided and why, one sentence each
};

/// Roles: a table with positions and a heading counter-clockwise or a name such as "truth" is the truth
/// (never the only positions); other positions are a receiver's; speed and yaw rate in one log are odometry,
/// each alone a part. A channel that an earlier log gives is not taken again; a log that is a receiver's
/// gives odometry only where no other does.
[[nodiscard]] DriveProposal propose_drive(const std::vector<LogInspection>& logs);

/// The drive.yaml: parses as it stands. `# CHECK` stands where something was proposed rather than known.
/// @param path  where it will lie: logs are named relative to its folder where they lie in or below it or
/// beside it, else absolutely
[[nodiscard]] std::string drive_yaml(const DriveProposal& proposal, const std::vector<LogInspection>& logs,
                                     const std::string& path);

/// All keys, commented, where no log was given.
[[nodiscard]] std::string drive_template();

}  // namespace waymark::inspection
