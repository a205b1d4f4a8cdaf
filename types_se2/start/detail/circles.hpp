/// The place of a point from its distances to known places (multilateration in the plane).
#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

namespace waymark {

/// A point is on a circle: its distance from a place was measured. Metres, in the axes of the frame.
struct Circle {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double radius = 0;
};

/// Returns the place from which the distances to the circles differ the least, for most of them: false ranges do
/// not move it, if nearly half or fewer are false. Pairs of circles that cross well propose places, and the best one is
/// then refined by all circles that agree with it.
/// @param near where centres on a line leave two mirrored places, the one that is nearer to this counts
/// @return nothing for fewer than two centres that are apart
[[nodiscard]] std::optional<Eigen::Vector2d> place_on_circles(std::span<const Circle> circles,
                                                              const Eigen::Vector2d& near);

}  // namespace waymark
