/// The steps of prepare_drive for odometry and for fixes.
#pragma once

#include <span>
#include <vector>

#include <waymark/core/drive/log_reader.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>

namespace waymark::drive {

/// Assembles each odometry that comes in parts, cleans it, subtracts the delays of its channels and cuts
/// it to the window of the drive. The source of the nodes is the first one. A source with fewer than two
/// usable samples is left out with a warning.
/// @throws InputError if no source is left
[[nodiscard]] std::vector<PreparedOdometry> prepare_odometry(const DriveLogs& logs,
                                                             const DriveDescription& description,
                                                             PrepareReport& report);

/// Returns the samples of the first source, and those of the others where it is silent.
/// @param added how many are those of others
[[nodiscard]] std::vector<OdometrySample> covered_by_all(const std::vector<PreparedOdometry>& relative,
                                                         std::size_t& added);

/// Returns how far apart samples of an odometry may be without a gap between them: as stated, or the
/// larger of timeline.gap_s and four usual intervals.
[[nodiscard]] double longest_interval_s(const DriveDescription& description,
                                        std::span<const OdometrySample> odometry);

/// Returns what is stated for a receiver.
[[nodiscard]] const GnssConfig& receiver_of(const DriveDescription& description, std::size_t source);

/// Adds logged velocities to the fixes, cleans them, subtracts their delay, drops those outside the
/// odometry and thins the rest. @throws InputError if there are receivers and no fix is left
[[nodiscard]] std::vector<GeodeticFix> prepare_fixes(const DriveLogs& logs,
                                                     const DriveDescription& description,
                                                     const std::vector<OdometrySample>& odometry,
                                                     PrepareReport& report);

}  // namespace waymark::drive
