/// Chords between fixes, in GNSS and in the odometry. They compare the two without a common frame.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/drive/nodes/timeline.hpp>

namespace waymark::drive {

/// One receiver, and the dead-reckoned antenna poses at its fixes. Headings are not wrapped.
struct ReckonedFixes {
  std::vector<Fix> fixes;
  std::vector<Eigen::Vector3d> antenna;
  std::vector<std::size_t> place;  ///< of each fix among those of all receivers
};

/// Returns the fixes of one receiver, one for each stamp.
/// @param antenna dead-reckoned antenna poses, one for each fix
[[nodiscard]] ReckonedFixes of_receiver(std::span<const Fix> fixes, std::span<const Eigen::Vector3d> antenna,
                                        int source);

/// The way between two fixes.
struct ChordPair {
  Eigen::Vector2d gnss = Eigen::Vector2d::Zero();
  Eigen::Vector2d odometry = Eigen::Vector2d::Zero();
  double duration_s = 0;
  double middle_s = 0;     ///< since the first fix of the receiver
  double heading_rad = 0;  ///< mean of the odometry along the chord, not wrapped
  double turn_rad = 0;     ///< of the odometry from its beginning to its end, not wrapped
  bool follows = false;    ///< it begins at the end of the previous chord
};

/// Returns the way from a fix to a later one. Its heading is 0; chords_of() knows it.
[[nodiscard]] ChordPair chord_between(const ReckonedFixes& receiver, std::size_t first, std::size_t last);

/// Returns chords one after another. Each is extended until it is complete.
/// @param is_complete of a chord
/// @param longest_s a chord that lasts longer is left out
[[nodiscard]] std::vector<ChordPair> chords_of(const ReckonedFixes& receiver, double longest_s,
                                               const std::function<bool(const ChordPair&)>& is_complete);

/// Returns by how much the odometry turns more than the fixes from one chord to the next, in (-pi, pi]: between the
/// chords themselves, whatever the headings along them.
[[nodiscard]] double turns_apart(const ChordPair& one, const ChordPair& next);

/// Returns the bias that the chords show in the median; none for few.
[[nodiscard]] YawBias bias_of(std::span<const ChordPair> chords);

/// Returns the fixes beside the odometry without an error of its yaw rate: what lies between two fixes is
/// turned as a whole.
[[nodiscard]] ReckonedFixes without_error(ReckonedFixes receiver, const YawError& error);

/// A turn from one chord to the next.
struct TurnPair {
  double gnss_rad = 0;      ///< in (-pi, pi]
  double odometry_rad = 0;  ///< between the mean headings along them, not wrapped
  /// turns_apart() of the chords: small if the turns have their size, also where the vehicle turns round
  /// within a chord, whose direction is no mean heading then
  double apart_rad = 0;
};

/// Returns the turns between chords that follow each other.
[[nodiscard]] std::vector<TurnPair> turns_of(std::span<const ChordPair> chords);

/// Returns the factor on the odometry's turns that explains the turns of the fixes: from -100 to -0.01
/// or from 0.01 to 100. Empty unless the turns differ from those of the fixes at most half as much
/// with it as with a factor of 1, of mean headings and of chords, and without turns.
[[nodiscard]] std::optional<double> factor_of_turns(std::span<const TurnPair> turns);

/// Whether speeds or turns may be wrong by a factor for want of calibration; beyond 4 they are read wrong.
[[nodiscard]] inline bool is_scale(double factor) {
  constexpr double kLargest = 4;
  return factor < kLargest && factor > 1 / kLargest;
}

/// A median with its standard deviation, if the values are independent.
struct Median {
  double value = 0;
  double spread = 0;  ///< standard deviation of one value, from the median absolute deviation
  double sigma = 0;   ///< of the median
};
/// @param values not empty
[[nodiscard]] Median median_with_sigma(std::vector<double> values);

}  // namespace waymark::drive
