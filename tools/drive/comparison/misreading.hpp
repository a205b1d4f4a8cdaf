/// Odometry, or positions, that were read in a wrong unit or sense: what no noise explains, and a word in
/// the drive.yaml mends.
#pragma once

#include <optional>
#include <span>
#include <string>

#include <waymark/core/drive/drive_context.hpp>
#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/drive/nodes/timeline.hpp>

namespace waymark::drive {

/// Finds the reading with which the odometry fits the fixes, if it does not as it was read: speeds in km/h,
/// mph, kn or mm/s or with a factor beyond 4, yaw rates in deg/s or of the other sense, both, or one of
/// coordinate_slips(). Each is dead-reckoned anew and compared along legs, that is chords of 20, 60 or 180 m of
/// the fixes: two that follow each other agree if their lengths do within 30 %, and the turn between them within
/// 0.3, 0.15 or 0.075 rad.
///
/// Empty unless the other reading makes at least ten pairs agree that did not, at most a tenth as many disagree
/// that did, and most agree: poor odometry, poor fixes and clocks apart are not mended by a unit.
/// Any other scale of the speed, and the scale and the bias of the gyro, are taken as calibration: the drive as it was
/// read has them.
/// Other yaw rates must also be better than none at all, because noise of a gyro is.
/// @returns what does not fit, with which reading it does, and how to state that
/// @param fixes in the order of timeline.fix_node; those of the first receiver are compared
/// @param standstill_mps of the odometry model
/// @param place where the drive is; empty: not known
[[nodiscard]] std::optional<std::string> find_misreading(const Timeline& timeline, std::span<const Fix> fixes,
                                                         double standstill_mps,
                                                         const std::optional<GeodeticPoint>& place);

}  // namespace waymark::drive
