/// Finds fixes that repeat one position while the odometry moves: a receiver that lost its satellites
/// and states the last position again, or a log that holds each fix until the next one.
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
  bool held = false;      ///< all repeated fixes of a log that holds its fixes
};

/// Returns the places that at least two further fixes repeat to the last digit while the odometry moves
/// away by 20 m or more. Coordinates with few digits repeat over shorter ways. Where at least 20 fixes
/// and half of those after a way of 5 cm or more repeat the one before, the log holds its fixes, and all
/// repeated ones of that receiver are one entry. Withheld fixes count.
/// @param fixes sorted by stamp
/// @param dead_reckoned antenna poses at the fixes, in any frame; same length and order
[[nodiscard]] std::vector<FrozenFixes> find_frozen_fixes(std::span<const Fix> fixes,
                                                         std::span<const Eigen::Vector3d> dead_reckoned);

/// Returns the warning for one of them. @param start first stamp of the fixes
[[nodiscard]] std::string warning_of(const FrozenFixes& frozen, Stamp start);

}  // namespace waymark::drive
