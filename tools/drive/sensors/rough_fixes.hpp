/// Positions that a sensor tells without a receiver, as fixes for frame and initial guess.
#pragma once

#include <vector>

#include <waymark/tools/drive/coordinates/projection.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>

namespace waymark::drive {

/// Returns a rough position as a fix, in the frame.
[[nodiscard]] Fix rough_fix(const RoughPosition& position, const Projection& projection);

/// Returns the rough positions of a log in the frame, sorted, stamps unique, on the scale of the drive.
/// Those that are more than 50 km from their median are left out.
[[nodiscard]] std::vector<Fix> rough_fixes(const DriveLogs::Log& log, TimeScale scale,
                                           const Projection& projection);

}  // namespace waymark::drive
