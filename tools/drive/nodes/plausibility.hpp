/// Compares the odometry with the fixes. It detects wrong units and signs, which otherwise only
/// show as rejected fixes.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/sample.hpp>

namespace waymark::drive {

/// Returns one sentence for each suspicious fact. The distances between fixes of 1 to 5 s may
/// differ by a factor (median over at least 20 of them beyond 1.5). The turns may have opposite
/// signs (correlation over at least 10 of them below -0.3).
/// @param antenna dead-reckoned antenna poses at the fixes, in any frame; same length and
/// order as `fixes`
[[nodiscard]] std::vector<std::string> compare_odometry_with_fixes(std::span<const Fix> fixes,
                                                                   std::span<const Eigen::Vector3d> antenna);

}  // namespace waymark::drive
