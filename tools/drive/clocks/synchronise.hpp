/// Puts the logs of a drive on one clock, using the motion that they all measure.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/drive/clocks/clock_sync.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>

namespace waymark::drive {

/// Returns the relative source of a name, such as PreparedOdometry::name.
[[nodiscard]] OdometryConfig& config_of(const std::string& name, DriveDescription& description);

/// Adds significant offsets of speed and yaw rate to the delays of an odometry. Halves of one log move together, if
/// what is said of the other half allows it. @param whose "the odometry's", for the notes
void apply_offsets(const std::string& whose, const SyncReport& report, OdometryConfig& odometry,
                   std::vector<std::string>& notes);

/// Moves fixes to the GNSS time in their log. Adds the offsets of speed and yaw rate of each
/// odometry against the fixes (clock_sync.hpp) to its delays. The logs receive one note for each
/// step. The logs are not read again; prepare_drive applies the delays.
/// @throws what prepare_drive throws
void synchronise(DriveLogs& logs, DriveDescription& description);

}  // namespace waymark::drive
