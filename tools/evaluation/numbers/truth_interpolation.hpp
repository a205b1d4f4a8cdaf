/// Truth at the PPS epochs, by linear interpolation between the two truth poses around an epoch.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <waymark/core/drive/sample.hpp>

namespace waymark::evaluation {

struct TruthOptions {
  /// Longest interval of truth that may be interpolated, in units of the median sampling interval
  /// of the truth; finite and >= 1.
  double max_gap_factor = 1.5;
  /// The direction of travel is that of a chord of the truth around the epoch. The chord spans at
  /// least this time in seconds, >= 0 (less at the ends and beside gaps). Consecutive poses of a
  /// 100 Hz truth are too close for a direction.
  double direction_span_s = 1.0;
  /// At a lower speed along that chord there is no direction of travel, m/s, > 0.
  double min_direction_speed_mps = 0.5;
};

/// Truth at one epoch, at the reference point of the truth.
struct TruthAtEpoch {
  TruthPose pose;  ///< with the stamp of the epoch
  /// direction of the truth's motion, counter-clockwise from grid east
  std::optional<double> direction_rad;
};

struct TruthMatch {
  /// one per epoch, in the given order; empty: not matched
  std::vector<std::optional<TruthAtEpoch>> at;
  std::size_t matched = 0;
  std::size_t before_truth = 0;       ///< epochs before the first truth pose
  std::size_t after_truth = 0;        ///< epochs after the last truth pose
  std::size_t in_gap = 0;             ///< epochs inside a gap of the truth
  double median_interval_s = 0;       ///< of the truth; NaN for fewer than two distinct stamps
  double longest_interpolated_s = 0;  ///< the longest interval that may be interpolated

  [[nodiscard]] std::size_t unmatched() const { return before_truth + after_truth + in_gap; }
};

/// Interpolates the truth at the epochs: position and height linearly, the heading along the shorter
/// arc. There is a heading or a height only if both neighbours have one. It never extrapolates and never crosses a
/// gap (TruthOptions). An epoch with the stamp of a truth pose takes that pose, even beside a gap
/// (the last one of several with that stamp). O(n log m) for n epochs and m truth poses.
/// @param truth stamps not decreasing, on the scale of the epochs
/// @param epochs in any order
/// @throws InputError for a truth that is empty, out of order, not finite, without overlap with the
/// epochs (the message has both time spans), or if every epoch is in a gap; UsageError for an
/// invalid option
[[nodiscard]] TruthMatch interpolate_truth(std::span<const TruthPose> truth, std::span<const Stamp> epochs,
                                           const TruthOptions& options = {});

/// Converts truth that is given as poses (a TUM file). Each pose has a heading.
[[nodiscard]] std::vector<TruthPose> truth_from_poses(std::span<const StampedPose> poses);

}  // namespace waymark::evaluation
