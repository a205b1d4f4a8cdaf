/// The frame of a drive, and the first pose that a drive.yaml states, in this frame.
#pragma once

#include <optional>
#include <span>

#include <waymark/core/drive/frame.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>

namespace waymark::drive {

/// Chooses the frame (choose_frame in projection.hpp) by the first place of the drive that is known: the
/// first fix, the stated first pose, or a place among the readings of a sensor. If none is geodetic and
/// no zone is stated, the frame is a local one (zone 0).
/// @throws InputError for an impossible place
[[nodiscard]] Frame frame_of(const DriveDescription& description, const DriveLogs& logs,
                             std::span<const GeodeticFix> fixes);

/// Returns the stated first pose in the frame. Empty if none is stated.
/// @throws InputError for a geodetic one in a local frame
[[nodiscard]] std::optional<FirstPose> first_pose_in(const Frame& frame, const DriveDescription& description);

}  // namespace waymark::drive
