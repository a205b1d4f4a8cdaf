/// Puts the logs of a drive on one clock, using the motion that they all measure.
#pragma once

#include <waymark/tools/drive/logs/prepare.hpp>

namespace waymark::drive {

/// Returns the relative source of a name, such as PreparedDrive::odometry_name.
[[nodiscard]] OdometryConfig& source_of_nodes(const std::string& name, DriveDescription& description);

/// Moves fixes to the GNSS time in their log. Adds the offsets of speed and yaw rate against the
/// fixes (clock_sync.hpp) to the delays of the description. The logs receive one note for each
/// step. The logs are not read again; prepare_drive applies the delays.
/// @throws what prepare_drive throws
void synchronise(DriveLogs& logs, DriveDescription& description);

}  // namespace waymark::drive
