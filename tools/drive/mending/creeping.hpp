/// Finds times in which a vehicle creeps unseen: many wheel sensors read 0 below some speed.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/drive/mending/sample_range.hpp>

namespace waymark::drive {

/// Samples that read 0 while the fixes move.
struct Creeping : SampleRange {
  double speed_mps = 0;  ///< of the fixes
};

/// Returns the slowest speed that the odometry shows beside 0, if that is 0.25 m/s or more; else 0.
[[nodiscard]] double dead_zone_mps(std::span<const OdometrySample> odometry);

/// Finds them, if the odometry has a dead zone. For 3 s or more all readings are 0. A line through the fixes of
/// that time has a speed within the dead zone (and a fifth), and leads along the way of the fixes before or after
/// it, within 35 degrees. It is longer than 0.3 m, and than 2.5 sigmas of what errors that last 30 s drift.
/// @param odometry sorted by stamp
/// @param fixes sorted by stamp; those of the first receiver that are not withheld are used
[[nodiscard]] std::vector<Creeping> find_creeping(std::span<const OdometrySample> odometry,
                                                  std::span<const Fix> fixes);

/// Gives the samples of those times the speed of the fixes, and marks them as assumed.
void creep(std::span<const Creeping> found, std::span<OdometrySample> odometry);

/// The edges of a dead zone that were passed.
struct PassedZone {
  double zone_mps = 0;    ///< 0: there is none
  std::size_t edges = 0;  ///< 0: nothing was changed
  double way_m = 0;       ///< that the vehicle moved unseen
};

/// Speeds that slow down to the edge of a dead zone go on to 0 as they came, and those that leave it come from 0: for
/// some tenths of a second, in which the vehicle moves by decimetres. Their way is as uncertain as it is
/// long (OdometrySample::distance_variance_per_s). The zone is 2 m/s at most and twice as large as the steps of the
/// readings; at five edges, and at half of all, the speed changes by 0.3 to 4 m/s^2 and by less than half the zone
/// between two readings, so that the first one of 0 cannot be true.
/// @param odometry sorted by stamp
PassedZone pass_dead_zone(std::span<OdometrySample> odometry);

/// Returns the note about them. @pre passed.edges > 0
[[nodiscard]] std::string note_of(const PassedZone& passed);

/// Returns the warning for all of them. @param found at least one
[[nodiscard]] std::string warning_of(std::span<const Creeping> found,
                                     std::span<const OdometrySample> odometry);

}  // namespace waymark::drive
