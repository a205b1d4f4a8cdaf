/// Whether two receivers differ all drive long by more than they claim. The fused positions lie between
/// them then, and no covariance tells.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/sample.hpp>

namespace waymark::drive {

/// Two receivers of which the second one is elsewhere.
struct ConstantDifference {
  int first = 0;                                       ///< Fix::source
  int second = 0;                                      ///< Fix::source
  Eigen::Vector2d second_m = Eigen::Vector2d::Zero();  ///< its antenna minus where it should be, median
  bool in_body =
      false;            ///< along the vehicle: x forwards, y to the left; otherwise in the frame: east, north
  bool turned = false;  ///< whether the vehicle has turned enough to tell the two apart
  double first_claims_m = 0;  ///< median accuracy
  double second_claims_m = 0;
};

/// Finds them. Accepted fixes of two receivers within a second are compared at the poses. The median
/// difference counts if it is twice what both claim together, and three of its sigmas, for errors that last a
/// minute. It is in the body if it is more constant there, beyond a tenth.
/// @param fixes sorted by stamp
/// @param poses common to all receivers, one for each fix: x, y [m, frame], heading [rad]. Their error cancels.
[[nodiscard]] std::vector<ConstantDifference> constant_differences(std::span<const Fix> fixes,
                                                                   std::span<const Eigen::Vector3d> poses);

/// @param names by Fix::source @param time in which it was seen
[[nodiscard]] std::string warning_of(const ConstantDifference& difference, std::span<const std::string> names,
                                     const std::string& time = "all drive long");

}  // namespace waymark::drive
