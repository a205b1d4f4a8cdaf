/// Finds times in which all speeds are a wrong multiple: a logger that changes their unit, one of two wheel sensors that
/// fails.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/drive/mending/sample_range.hpp>

namespace waymark::drive {

/// Samples whose speeds times a factor are those of the fixes.
struct FactorChange : SampleRange {
  double factor = 1;
  double way_m = 0;  ///< of the fixes in that time
};

/// Finds them, by legs of 60 m and 15 accuracies of the fixes. In some of them, five or more of 300 m together, the fixes
/// go as far as the odometry, within 15 %. In five or more others in a row, of 300 m together, they go farther or less far
/// by 40 % and more; four in five of these agree on the factor within 12 %. So fixes that drift, wheels that slip and a
/// unit that is wrong all the time are none. A leg is compared with the straight way of the odometry, so bends do not
/// matter.
/// @param odometry sorted by stamp
/// @param fixes sorted by stamp; those of the first receiver that are not withheld are used
[[nodiscard]] std::vector<FactorChange> find_factor_changes(std::span<const OdometrySample> odometry,
                                                            std::span<const Fix> fixes);

/// Multiplies the speeds of those times.
void take_factors(std::span<const FactorChange> found, std::span<OdometrySample> odometry);

/// Returns the warning for one of them.
[[nodiscard]] std::string warning_of(const FactorChange& change, std::span<const OdometrySample> odometry);

}  // namespace waymark::drive
