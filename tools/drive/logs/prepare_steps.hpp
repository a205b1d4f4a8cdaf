/// The steps of prepare_drive for odometry and for fixes.
#pragma once

#include <span>
#include <vector>

#include <waymark/core/drive/log_reader.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>

namespace waymark::drive {

/// Assembles odometry that comes in parts, cleans it, subtracts the delays of its channels and cuts
/// it to the window of the drive. @throws InputError for fewer than two usable samples
[[nodiscard]] std::vector<OdometrySample> prepare_odometry(const DriveLogs& logs,
                                                           const DriveDescription& description,
                                                           PrepareReport& report);

/// Returns how far apart samples of the odometry may be without a gap between them: as stated, or the
/// larger of timeline.gap_s and four usual intervals.
[[nodiscard]] double longest_interval_s(const DriveDescription& description,
                                        std::span<const OdometrySample> odometry);

/// Adds logged velocities to the fixes, cleans them, subtracts their delay, drops those outside the
/// odometry and thins the rest. @throws InputError if no fix is left
[[nodiscard]] std::vector<GeodeticFix> prepare_fixes(const DriveLogs& logs,
                                                     const DriveDescription& description,
                                                     const std::vector<OdometrySample>& odometry,
                                                     PrepareReport& report);

}  // namespace waymark::drive
