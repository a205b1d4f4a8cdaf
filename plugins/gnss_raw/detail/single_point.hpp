/// Positions from the pseudoranges of single epochs, robustly: a start for drives without fixes.
#pragma once

#include <optional>

#include <waymark/plugins/gnss_raw/detail/epochs.hpp>

namespace waymark::plugins::gnss_raw {

struct SinglePoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< of the antenna, ECEF, m
  double clock_m = 0;
  double residual_m = 0;  ///< median of the sizes of the residuals
};

/// Solves an epoch with at least five pseudoranges. Least squares begin at `guess` (the centre of the
/// Earth will do). Then Cauchy weights follow, whose scale falls from 100 m to 8 m (graduated), so one in
/// three satellites may be wrong. Differences of the systems are left out of account.
/// @param turned whether the satellites are in the axes of the moment of reception already
/// @returns nothing if there is no solution near the surface of the Earth
[[nodiscard]] std::optional<SinglePoint> single_point(const Epoch& epoch, const Eigen::Vector3d& guess,
                                                      bool turned);

}  // namespace waymark::plugins::gnss_raw
