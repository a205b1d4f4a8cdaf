/// Clocks first: before anything is fused, the motion that odometry and GNSS share tells whether their
/// stamps belong together.
#pragma once

#include <set>
#include <string>
#include <vector>

#include <waymark/tools/drive/logs/prepare.hpp>

namespace waymark::drive {

/// What is done about the clock of the only odometry if it is more than two seconds apart from that of the
/// fixes. Nearer, the fixes may be late (time_offset).
enum class ClocksApart {
  move,  ///< its stamps are moved to the clock of the fixes, and a warning tells it
  tell   ///< a warning tells it: the stamps are those of a drive that goes on
};

/// prepare_drive(), and a warning if odometry and fixes fit at another offset of their clocks. One of speed and yaw rate
/// that is late alone is moved (ClocksApart::move, and no delay stated) or told (late_quantity.hpp). Several odometries
/// are compared one by one, and those that the fixes contradict are left out (odometry_check.hpp).
/// @param suspects odometries that were left out of an earlier part of the drive
/// @throws InputError what prepare_drive throws; and if most fixes lie outside the odometry and their motion
/// fits elsewhere, or nowhere: it names the offset and the remedy
[[nodiscard]] PreparedDrive prepare_on_one_clock(const DriveLogs& logs, const DriveDescription& description,
                                                 ClocksApart treatment,
                                                 const std::set<std::string>& suspects = {});

/// All odometries and the fixes of all receivers, less their stated delays: nothing is cut to the time of the
/// other.
struct LoggedMotion {
  std::vector<PreparedOdometry> odometries;  ///< at least one
  std::vector<Fix> fixes;                    ///< in the zone of the first one

  /// Of the nodes.
  [[nodiscard]] const std::vector<OdometrySample>& odometry() const { return odometries.front().samples; }
};
/// @throws what prepare_odometry throws
[[nodiscard]] LoggedMotion logged_motion(const DriveLogs& logs, const DriveDescription& description);

}  // namespace waymark::drive
