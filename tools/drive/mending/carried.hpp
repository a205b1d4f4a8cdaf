/// Finds times in which the vehicle was carried: a ferry, a train, a tow truck. Its wheels stand, there are no
/// fixes, and afterwards it is elsewhere.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/drive/mending/sample_range.hpp>

namespace waymark::drive {

/// Samples that stand, and say nothing of the motion.
struct Carried : SampleRange {
  double distance_m = 0;  ///< between the fixes around them, less the way of the odometry
};

/// Finds them. Between two fixes that follow one another all samples of 10 s or more read less than 0.1 m/s, and
/// the fixes are 100 m and ten sigmas further apart than the odometry's way. Three fixes before and three after,
/// within a minute, are where the odometry has them, within a quarter of that: so no single fix is wrong.
/// @param odometry sorted by stamp
/// @param fixes sorted by stamp; those of the first receiver that are not withheld are used
[[nodiscard]] std::vector<Carried> find_carried(std::span<const OdometrySample> odometry,
                                                std::span<const Fix> fixes);

/// Returns the warning for one of them. @param start first stamp of the odometry
[[nodiscard]] std::string warning_of(const Carried& carried, std::span<const OdometrySample> odometry,
                                     Stamp start);

}  // namespace waymark::drive
