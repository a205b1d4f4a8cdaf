/// The rigid motion of the plane that moves points onto others.
#pragma once

#include <optional>
#include <span>

#include <waymark/types_se2/se2.hpp>

namespace waymark {

/// One point in the axes of two frames, metres.
struct PointPair {
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  Eigen::Vector2d to = Eigen::Vector2d::Zero();
};

/// Returns a point of the moved frame in the other one.
[[nodiscard]] inline Eigen::Vector2d moved(const Pose2<double>& motion, const Eigen::Vector2d& point) {
  return motion.position + rotate(motion.heading, point);
}

/// Returns the motion, without mirroring or scale, that leaves the least sum of distances: false pairs do not
/// turn it, if fewer than half are false. Two pairs at a time propose motions, and the best one is then refined.
/// @return nothing where no two pairs have points that are apart, and equally far in both frames to a tenth
/// or half a metre
[[nodiscard]] std::optional<Pose2<double>> rigid_alignment(std::span<const PointPair> pairs);

}  // namespace waymark
