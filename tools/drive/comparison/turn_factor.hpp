/// The scale of the yaw rate beside the turns of the fixes: a gyro whose sensitivity is wrong, a track width or a
/// steering ratio that is.
#pragma once

#include <cstddef>
#include <optional>

#include <waymark/tools/drive/comparison/chords.hpp>

namespace waymark::drive {

/// How many times the odometry turns as the fixes do.
struct TurnFactor {
  double value = 1;
  double sigma = 0;       ///< of the factor
  std::size_t turns = 0;  ///< of 15 degrees and more, that of the fixes or of the odometry
};

/// Returns the factor if it explains the turns of the fixes and those of the odometry as they were read do not: it
/// differs from 1 by five sigmas, and by more the fewer turns there are (9 % of ten, 5 % of forty; fewer than six tell
/// nothing). Empty beyond 1/4 and 4, and for a negative one, which are a matter of units and senses.
///
/// The turns between nearly straight chords of 20, 60 or 180 m, whichever tell most, less the bias of the gyro, are
/// fitted robustly (Huber) by those of the odometry, and those of the odometry by those of the fixes. Errors of the
/// fixes make the second factor smaller, a noisy gyro makes the first one larger; so both must say it, and what is
/// returned is the one that says less.
/// @param first where to begin: one that is near is needed beyond 2, where turns would be half turns apart
[[nodiscard]] std::optional<TurnFactor> turn_factor(const ReckonedFixes& receiver, double first = 1);

}  // namespace waymark::drive
