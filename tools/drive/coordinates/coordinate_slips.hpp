/// Positions that were written wrong in a way that has a name: exchanged columns, a lost sign, degrees
/// and minutes read as degrees.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/drive_context.hpp>
#include <waymark/core/drive/sample.hpp>

namespace waymark::drive {

struct CoordinateSlip {
  std::string_view words;                            ///< "latitude and longitude are exchanged"
  GeodeticPoint (*mended)(const GeodeticPoint& at);  ///< the place that was meant
  /// a mirror: odometry cannot tell it from a yaw rate of the other sense
  bool mirrors = false;
};

/// The slips that are known.
[[nodiscard]] std::span<const CoordinateSlip> coordinate_slips();

/// Returns the words of slips. Mirrors are told once: north and south, east and west look alike to an odometry.
[[nodiscard]] std::vector<std::string> words_of(std::span<const CoordinateSlip* const> slips);

/// Returns what a slip does to short ways: meant = M * written, in metres east and north.
/// @param at where, as written
[[nodiscard]] Eigen::Matrix2d mending(const CoordinateSlip& slip, const GeodeticPoint& at);

/// Returns a warning if the truth is more than a kilometre from the fixes of its time in the median. It
/// names the slip that brings them together, if there is one. Empty otherwise.
/// @param fixes, truth sorted by stamp
[[nodiscard]] std::string warning_of_distance(std::span<const GeodeticFix> fixes,
                                              std::span<const GeodeticTruth> truth);

}  // namespace waymark::drive
