/// Errors without the constant offset of the vehicle: that of a wrong lever arm.
#pragma once

#include <optional>
#include <span>

#include <waymark/tools/evaluation/numbers/metrics.hpp>

namespace waymark::evaluation {

/// A constant offset in the directions of the vehicle, and the errors that remain without it.
struct OffsetTakenOut {
  double along_m = kUndefined;  ///< mean offset ahead
  double cross_m = kUndefined;  ///< mean offset to the left
  PositionMetrics rest;         ///< of the offsets without it; only those with a direction
};

/// @param directions_rad direction of travel at each offset, counter-clockwise from grid east
/// @throws UsageError if the lengths differ
[[nodiscard]] OffsetTakenOut without_constant_offset(std::span<const Eigen::Vector2d> offsets,
                                                     std::span<const std::optional<double>> directions_rad);

}  // namespace waymark::evaluation
