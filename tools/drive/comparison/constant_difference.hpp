/// Whether two receivers differ all drive long by more than they claim. The fused positions lie between
/// them then, and no covariance tells. Of three, the one that differs from two that agree is known to be wrong;
/// of two and two, nobody is.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
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
  /// the fixes of the second are later than those of the first, s: that alone explains the difference
  std::optional<double> late_s{};
  double first_claims_m = 0;  ///< median accuracy
  double second_claims_m = 0;
};

/// What the comparison of each two receivers says.
struct ComparedReceivers {
  std::vector<ConstantDifference> differ;
  std::vector<std::pair<int, int>> agree;  ///< Fix::source of both
};

/// Compares accepted fixes of two receivers within a second at the poses. The median difference counts if it is
/// twice what both claim together, and three of its sigmas, for errors that last a minute; few minutes say
/// little of their spread (Student), fewer than three nothing. It is in the body if it is more constant there,
/// beyond a tenth. It is one of clocks if nothing that counts is left without what grows with the speed.
/// @param fixes sorted by stamp
/// @param poses common to all receivers, one for each fix: x, y [m, frame], heading [rad]. Their error cancels.
[[nodiscard]] ComparedReceivers compare_receivers(std::span<const Fix> fixes,
                                                  std::span<const Eigen::Vector3d> poses);

/// Returns the receivers that differ, not by their clocks, from others that agree and are more than those that agree
/// with them.
/// @param voices of each Fix::source: sources with common errors have one voice
[[nodiscard]] std::vector<int> outvoted(const ComparedReceivers& compared,
                                        std::span<const std::size_t> voices);

/// @param names by Fix::source @param time in which it was seen
[[nodiscard]] std::string warning_of(const ConstantDifference& difference, std::span<const std::string> names,
                                     const std::string& time = "all drive long");

/// Returns the sentence that follows if both are used; empty for clocks, which the model may find.
[[nodiscard]] std::string consequence_of(const ConstantDifference& difference);

}  // namespace waymark::drive
