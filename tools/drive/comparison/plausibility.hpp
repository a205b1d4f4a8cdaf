/// Compares the odometry with the fixes. It detects wrong units and signs, and jumps of the receiver,
/// which otherwise only show as rejected fixes or as errors.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/drive_context.hpp>
#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/drive/comparison/chords.hpp>

namespace waymark::drive {

struct ComparedWithFixes {
  std::vector<std::string> warnings;
  std::optional<double> speed_factor{};  ///< as Shape::speed_factor
  std::optional<double> turn_factor{};   ///< as Shape::turn_factor
  std::optional<YawBias> yaw_bias{};     ///< as Shape::yaw_bias
};

/// Returns one sentence for each suspicious fact:
/// - The turns have another size or sign than those of the fixes (at least 8 turns of 15 degrees).
/// - The turns differ by a factor that is significant, and beyond 4 % or more (turn_factor.hpp).
/// - The distances differ by a factor beyond 1.5 (median over at least 10 chords of about 20 m).
/// - The distances differ by a factor that is significant, and beyond 3 % (median over at least 10
///   chords of 100 m, compared with its own uncertainty).
/// - Fixes repeat one position while the odometry moves (frozen_fixes.hpp).
/// - The fixes jump by 50 m or more and stay there for 10 s or more, or by 20 m or more and back.
/// Where the fixes fit once their coordinates are mended (coordinate_slips.hpp), the sentence names that.
/// @param fixes those of the first receiver are compared; of the others only the jumps are named
/// @param antenna dead-reckoned antenna poses at the fixes, in any frame, with headings that are not
/// wrapped; same length and order as `fixes`
/// @param place of the drive; empty: not known
/// @param receivers names by Fix::source
/// @param odometry its name, if it is one of several: its turns and distances were told before
/// (odometry_check.hpp), and only what explains them otherwise is
[[nodiscard]] ComparedWithFixes compare_odometry_with_fixes(std::span<const Fix> fixes,
                                                            std::span<const Eigen::Vector3d> antenna,
                                                            const std::optional<GeodeticPoint>& place = {},
                                                            std::span<const std::string> receivers = {},
                                                            const std::string& odometry = {});

/// What is wrong with turns and distances.
struct Shape {
  std::vector<std::string> sentences;
  bool contradicts = false;   ///< a sign or a unit is wrong, which no prior allows
  bool spoils_jumps = false;  ///< jumps mean nothing then
  /// of the odometry's distances, if it is significant and beyond the prior of speed_scale
  std::optional<double> speed_factor{};
  std::optional<double> turn_factor{};  ///< of the odometry's turns, if it is significant (turn_factor.hpp)
  std::optional<YawBias> yaw_bias{};    ///< what is left of them, if it is large
};
/// Compares turns and distances alone. @param fixes of one receiver @param antenna as above
[[nodiscard]] Shape compare_shapes(std::span<const Fix> fixes, std::span<const Eigen::Vector3d> antenna);

/// Returns a warning if the acceleration across the vehicle exceeds 10 m/s^2 in 5 % of the samples above
/// 2 m/s: a wrong unit of the yaw rate also shows without turns in the fixes. Empty otherwise.
[[nodiscard]] std::string warning_of_accelerations(std::span<const OdometrySample> odometry);

}  // namespace waymark::drive
