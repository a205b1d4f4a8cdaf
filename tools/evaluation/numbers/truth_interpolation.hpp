/// Truth at the PPS epochs: linear interpolation between the two truth poses around an epoch.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <waymark/core/drive/sample.hpp>

namespace waymark::evaluation {

struct TruthOptions {
  /// Longest interval of truth that is interpolated across, in units of the truth's own median sampling
  /// interval; finite and >= 1.
  double max_gap_factor = 1.5;
  /// The direction of travel is taken from the chord of the truth over at least this time around the epoch
  /// (less at the ends and beside gaps), in seconds, >= 0: neighbouring poses of a 100 Hz truth are too close
  /// for a direction.
  double direction_span_s = 1.0;
  /// Below this speed along that chord a direction of travel is not given, m/s, > 0.
  double min_direction_speed_mps = 0.5;
};

/// Truth at one epoch, at the truth's own reference point.
struct TruthAtEpoch {
  TruthPose pose;                       ///< stamp is that of the epoch
  std::optional<double> direction_rad;  ///< of the truth's motion, counter-clockwise from grid east
};

struct TruthMatch {
  std::vector<std::optional<TruthAtEpoch>> at;  ///< one per epoch, in the order given; empty: unmatched
  std::size_t matched = 0;
  std::size_t before_truth = 0;       ///< epochs earlier than the first truth pose
  std::size_t after_truth = 0;        ///< epochs later than the last truth pose
  std::size_t in_gap = 0;             ///< epochs inside a gap of the truth
  double median_interval_s = 0;       ///< of the truth; NaN below two distinct stamps
  double longest_interpolated_s = 0;  ///< the longest interval that was allowed to be crossed

  [[nodiscard]] std::size_t unmatched() const { return before_truth + after_truth + in_gap; }
};

/// Interpolates the truth at the epochs: position linearly, heading along the shorter arc; a heading is given
/// only where both neighbours have one. Never extrapolates, never crosses a gap (TruthOptions); an epoch that
/// carries the stamp of a truth pose takes that pose (the last of several with one stamp) even beside a gap.
/// O(n log m) for n epochs and m truth poses.
/// @param truth   stamps not decreasing, on the scale of the epochs.
/// @param epochs  in any order.
/// @throws InputError for truth that is empty, out of order, not finite, without overlap with the epochs (the
///         message has both time spans) or with every epoch in a gap;
///         UsageError for an invalid option.
[[nodiscard]] TruthMatch interpolate_truth(std::span<const TruthPose> truth, std::span<const Stamp> epochs,
                                           const TruthOptions& options = {});

/// Truth given as poses (a TUM file): every one has a heading.
[[nodiscard]] std::vector<TruthPose> truth_from_poses(std::span<const StampedPose> poses);

}  // namespace waymark::evaluation
