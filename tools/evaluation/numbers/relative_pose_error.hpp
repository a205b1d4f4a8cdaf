/// Relative pose error: the error of the motion over a distance, wherever it begins. It shows
/// drift, which a constant offset hides, and it does not depend on the frame.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/evaluation/numbers/metrics.hpp>

namespace waymark::evaluation {

/// The distances that reports show, m.
inline constexpr std::array kRelativeDistances{10.0, 100.0, 1000.0};

/// Errors of the motions over one distance.
struct RelativePoseError {
  double distance_m = 0;
  ScalarStatistics translation_m;  ///< |translation of E|
  ScalarStatistics rotation_rad;   ///< |rotation of E|
};

/// Returns E = (T_i^-1 T_j)^-1 (P_i^-1 P_j) over all pairs (i, j), as `evo_rpe --delta D
/// --delta_unit m --pairs_from_reference` does for the pairs of its chain: from each begin the
/// next one is the first pose that is at least D further along the truth. T is the truth, P the
/// estimate.
/// @param truth, estimated poses x, y [m], heading [rad]; one for each other, in order of time
/// @throws UsageError if the lengths differ
[[nodiscard]] RelativePoseError relative_pose_error(std::span<const Eigen::Vector3d> truth,
                                                    std::span<const Eigen::Vector3d> estimated,
                                                    double distance_m);

}  // namespace waymark::evaluation
