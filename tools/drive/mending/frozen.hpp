/// Finds times in which the odometry repeats one reading although the fixes move otherwise: a sensor
/// or a logger that stopped.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <waymark/core/drive/sample.hpp>

namespace waymark::drive {

/// A time in which the odometry was not measured.
struct FrozenOdometry {
  Stamp from;                 ///< of its first sample
  Stamp to;                   ///< of its last sample
  double speed_mps = 0;       ///< of its first sample
  double yaw_rate_radps = 0;  ///< of its first sample
  double distance_m = 0;      ///< between the fixes in this time
  bool with_speed = false;    ///< the samples repeat their speed
  bool with_turns = false;    ///< the samples repeat their yaw rate
  bool at_rest =
      false;  ///< the samples do not repeat a speed; all of them are those of a vehicle that stands
};

/// Finds them with the fixes of the first receiver that are not withheld.
///
/// A moving vehicle seldom repeats a reading. If at most 30 % of the pairs of samples repeat their speed, and as few
/// their yaw rate, 3 s of one speed above 0.5 m/s and one yaw rate are such a time: 20 samples, and five times as many
/// as usual. So are 5 s of one speed alone if the fixes contradict it: their chords are longer than its way, or their
/// steps of 2 s together shorter, by 6 % and the accuracy of a fix. Without fixes it may be cruise control, or a speed
/// of few digits. So are 5 s of one yaw rate, unless it comes from wheels or steering. Turns that good fixes confirm are
/// true: in each 20 s the fixes lie on the way of the odometry, within their accuracy and 0.5 % of its length, and are
/// accurate to 1 % of it. A yaw rate from wheels or steering repeats itself together with the speed on a straight road: it
/// is frozen only if the fixes show another turn, or another speed.
///
/// Otherwise the speed is the same in each sample for 5 s or more. The fixes contradict it in at least
/// four chords in a row, of 2 to 10 s each. Every chord differs from the odometry's distance by at least 5 m, 1 m/s and three
/// sigmas of the fixes; all of them together by at least 30 m and ten sigmas. The chords have a
/// common direction, within 60 degrees from each to the next: fixes of a standing receiver wander
/// without one. If the receiver measures its speed, this speed must contradict the odometry too. Or the speed is
/// below 0.5 m/s in each sample for 5 s or more, and the fixes contradict its first one so: wheels whose sensor
/// fails read noise, and so do those of a vehicle on a ferry. Such a time lasts from the first to the last contradiction.
/// @param odometry sorted by stamp
/// @param fixes sorted by stamp
/// @param from_wheels the yaw rate is known to come from wheels or steering; otherwise readings at rest tell it
[[nodiscard]] std::vector<FrozenOdometry> find_frozen_odometry(std::span<const OdometrySample> odometry,
                                                               std::span<const Fix> fixes,
                                                               bool from_wheels = false);

/// Gives the frozen readings of those times the motion of the fixes, and marks the samples as assumed. The
/// speed is that of the receiver, or that of its positions over 5 s.
/// @param fixes as for find_frozen_odometry
void assume_motion_of_fixes(std::span<const FrozenOdometry> frozen, std::span<const Fix> fixes,
                            std::span<OdometrySample> odometry);

/// Returns the warning for one of them. @param start first stamp of the odometry
[[nodiscard]] std::string warning_of(const FrozenOdometry& frozen, Stamp start);

}  // namespace waymark::drive
