/// Puts the logs of a drive onto one clock by what they say of the same motion.
#pragma once

#include <waymark/tools/drive/logs/prepare.hpp>

namespace waymark::drive {

/// An offset within this many of its sigmas counts as zero.
inline constexpr double kOffsetSigmas = 3;

/// Puts fixes onto the GNSS time that their log tells of, and adds the offsets of speed and yaw rate against
/// the fixes (clock_sync.hpp) to the delays of the description. What was done is noted in the logs, a
/// sentence each. The logs are not read again; prepare_drive applies what was found.
/// @throws what prepare_drive throws
void synchronise(DriveLogs& logs, DriveDescription& description);

}  // namespace waymark::drive
