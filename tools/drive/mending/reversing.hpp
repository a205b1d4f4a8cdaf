/// Finds times in which a vehicle drives backwards although its speed has no sign, by its fixes.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/drive/mending/sample_range.hpp>

namespace waymark::drive {

/// Samples between two stops, driven backwards.
struct Reversing : SampleRange {};

/// Finds them if no speed is negative. A way between two stops (below 0.5 m/s) is compared with those
/// before and after it: turned by the angle that lays the odometry of one on its fixes, the odometry of the
/// other leads to its fixes, or away from them. Of all choices of the directions the one counts in which
/// the ways fit each other best; forwards is preferred. The bias of the yaw rate and its turns per metre
/// are found by short times that follow each other, and removed before: else they turn each way against the
/// next. Ways whose fixes do not have the shape of the odometry are not judged, nor are those shorter than
/// 5 m, and than the fixes are accurate.
/// @param odometry sorted by stamp
/// @param fixes sorted by stamp; those of the first receiver that are not withheld are used
[[nodiscard]] std::vector<Reversing> find_reversing(std::span<const OdometrySample> odometry,
                                                    std::span<const Fix> fixes);

/// Gives the speeds of those times their sign. A yaw rate from wheels or steering changes with it.
void drive_backwards(std::span<const Reversing> found, std::span<OdometrySample> odometry);

/// Returns the warning for all of them. @param found at least one
[[nodiscard]] std::string warning_of(std::span<const Reversing> found,
                                     std::span<const OdometrySample> odometry);

}  // namespace waymark::drive
