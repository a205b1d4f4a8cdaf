/// Clocks first: before anything is fused, the motion that odometry and GNSS share tells whether their
/// stamps belong together.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/drive/logs/prepare.hpp>

namespace waymark::drive {

/// Returns what an offset between clocks usually is: "18 leap seconds (GPS time against UTC)", "2 h of a time
/// zone", "a GPS week", "1024 GPS weeks (a rollover of the week number)", "the GPS epoch against the Unix
/// epoch", and two of these together. Empty: nothing that is known.
/// @param tolerance_s how far off it may be
[[nodiscard]] std::string name_of_offset(double seconds, double tolerance_s);

struct ClockOffset;
/// Returns ", " and the name of an estimated offset, for messages. Empty: it has none.
[[nodiscard]] std::string offset_in_words(const ClockOffset& offset);

/// prepare_drive(), and a warning if odometry and fixes fit at another offset of their clocks. Of several
/// odometries each one is compared: its clock, its turns and its distances.
/// @throws InputError what prepare_drive throws; and if most fixes lie outside the odometry and their motion
/// fits elsewhere, or nowhere: it names the offset and the remedy
[[nodiscard]] PreparedDrive prepare_on_one_clock(const DriveLogs& logs, const DriveDescription& description);

/// Odometry and fixes of all receivers, less their stated delays: nothing is cut to the time of the other.
struct LoggedMotion {
  std::string source;  ///< name of the odometry
  std::vector<OdometrySample> odometry;
  std::vector<Fix> fixes;  ///< in the zone of the first one
};
/// @throws what prepare_odometry throws
[[nodiscard]] LoggedMotion logged_motion(const DriveLogs& logs, const DriveDescription& description);

}  // namespace waymark::drive
