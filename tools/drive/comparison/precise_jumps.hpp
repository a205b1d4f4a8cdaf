/// Jumps of fixes that claim centimetres: a phase solution whose ambiguities are wrong keeps its claim.
#pragma once

#include <vector>

#include <waymark/tools/drive/comparison/chords.hpp>
#include <waymark/tools/drive/comparison/jumps.hpp>

namespace waymark::drive {

/// Finds steps from a fix to the next one, at most 5 s later, that leave 15 times what both claim, and 0.2 m, beside
/// the step of the odometry as it lies on the 30 m before and after; claims of a metre or more are left to jumps_of().
/// What the steps of 10 s before and after leave in the median is no jump (an antenna elsewhere in a long bend), and
/// each of them leaves at most a third of that of the jump. It is also three times what all but 2 % of the drive's
/// steps leave: turns with an antenna elsewhere, braking with a lag.
/// @returns jumps in the order of time, with `first`, `settled`, `by` and `claimed_m` only
[[nodiscard]] std::vector<Jump> precise_jumps_of(const ReckonedFixes& receiver);

}  // namespace waymark::drive
