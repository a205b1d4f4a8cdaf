/// The steps of prepare_drive for odometry and for fixes.
#pragma once

#include <vector>

#include <waymark/core/drive/log_reader.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>

namespace waymark::drive {

/// Assembles odometry that comes in parts, cleans it, subtracts the delays of its channels and cuts
/// it to the window of the drive. @throws InputError for fewer than two usable samples
[[nodiscard]] std::vector<OdometrySample> prepare_odometry(const DriveLogs& logs,
                                                           const DriveDescription& description,
                                                           PrepareReport& report);

/// Adds logged velocities to the fixes, cleans them, subtracts their delay, drops those outside the
/// odometry and thins the rest. @throws InputError if no fix is left
[[nodiscard]] std::vector<GeodeticFix> prepare_fixes(const DriveLogs& logs,
                                                     const DriveDescription& description,
                                                     const std::vector<OdometrySample>& odometry,
                                                     PrepareReport& report);

}  // namespace waymark::drive
