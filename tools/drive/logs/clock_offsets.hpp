/// Offsets of clocks that a log or a description states.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>

namespace waymark::drive {

/// Returns what the messages of a log reveal about the clock of its stamps. Empty if the log holds
/// no GNSS time.
[[nodiscard]] std::optional<ClockReport> clock_of(const DriveLogs::Log& log);

/// Moves fixes to the GNSS time that is in their log. @return one sentence for each such log
std::vector<std::string> put_on_told_time(DriveLogs& logs);

/// Returns odometry with speed and yaw rate moved earlier by their delays. All stamps move by the
/// common part. The rest is interpolated between readings. Samples whose reading would be beyond an
/// end are dropped.
[[nodiscard]] std::vector<OdometrySample> without_delays(const std::vector<OdometrySample>& odometry,
                                                         double speed_delay_s, double yaw_rate_delay_s);

}  // namespace waymark::drive
