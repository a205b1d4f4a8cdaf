/// A place from distances to known points that have an offset in common, robustly.
#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

#include <waymark/core/base/export.hpp>

namespace WAYMARK_EXPORT waymark {

/// A measured distance to a known point, as a pseudorange is one to a satellite.
struct MeasuredRange {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< ECEF, m
  double measured_m = 0;                            ///< distance + common offset + error
};

struct PlaceFromRanges {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< ECEF, m
  double offset_m = 0;                                 ///< common to all ranges: the clock of a receiver
  double residual_m = 0;                               ///< median of the sizes of the residuals
};

/// Solves at least five ranges. Least squares begin at `guess` (the centre of the Earth will do). Then Cauchy
/// weights follow, whose scale falls from 100 m to 8 m (graduated), so one in three ranges may be wrong.
/// @returns nothing if there is no solution near the surface of the Earth
[[nodiscard]] std::optional<PlaceFromRanges> place_from_ranges(std::span<const MeasuredRange> ranges,
                                                               const Eigen::Vector3d& guess);

}  // namespace waymark
