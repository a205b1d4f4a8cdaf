/// Finds fixes that repeat one position while the odometry moves: a receiver that lost its satellites
/// and states the last position again.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/sample.hpp>

namespace waymark::drive {

/// Fixes of one receiver with the same coordinates.
struct FrozenFixes {
  std::vector<std::size_t> repeated;  ///< indices, without the first fix at this place
  Stamp from;                         ///< of the first fix at this place
  Stamp to;
  double distance_m = 0;  ///< that the odometry moved meanwhile
};

/// Returns the places that at least two further fixes repeat to the last digit while the odometry moves
/// away by 20 m or more. Coordinates with few digits repeat over shorter ways. Withheld fixes count.
/// @param fixes sorted by stamp
/// @param dead_reckoned antenna poses at the fixes, in any frame; same length and order
[[nodiscard]] std::vector<FrozenFixes> find_frozen_fixes(std::span<const Fix> fixes,
                                                         std::span<const Eigen::Vector3d> dead_reckoned);

/// Returns the warning for one of them. @param start first stamp of the fixes
[[nodiscard]] std::string warning_of(const FrozenFixes& frozen, Stamp start);

}  // namespace waymark::drive
