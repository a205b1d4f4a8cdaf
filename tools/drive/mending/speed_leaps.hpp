/// Finds times in which the speed of the odometry leaps away and back faster than any vehicle
/// accelerates: wheels that lock or spin, and readings of a broken sensor.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/drive/mending/sample_range.hpp>

namespace waymark::drive {

/// How long a leap takes, and how long it lasts until the leap back, at most.
constexpr double kLeapTakes_s = 0.3;
constexpr double kLeapLasts_s = 5;
/// Changes of smaller speeds do not count.
constexpr double kLeastLeap_mps = 2.5;

/// Tells whether no vehicle changes its speed so. @param usual_mps sigma of the change from sample to sample
[[nodiscard]] bool is_speed_leap(double change_mps, double time_s, double usual_mps);
/// Tells whether a vehicle may have changed its speed so.
[[nodiscard]] bool is_possible_change(double change_mps, double time_s);

/// Samples between a leap and the leap back.
struct SpeedLeap : SampleRange {};

/// Finds them. A leap is a change of 2.5 m/s more than 15 m/s^2 allow (and 8 sigmas of the change from
/// sample to sample) within 0.3 s or one interval. It counts if another one leads back, within 5 s, to a
/// speed that 10 m/s^2 allow (and 1 m/s). Where more than one sample in 20 would be in such times, the
/// speed is rough throughout, and none is returned.
/// @param odometry sorted by stamp
[[nodiscard]] std::vector<SpeedLeap> find_speed_leaps(std::span<const OdometrySample> odometry);

/// Gives the samples of those times a speed that is linear between the samples around them, and marks them
/// as assumed. The yaw rate is kept.
void bridge_speed_leaps(std::span<const SpeedLeap> leaps, std::span<OdometrySample> odometry);

/// Returns the warning for all of them. @param leaps at least one
[[nodiscard]] std::string warning_of(std::span<const SpeedLeap> leaps,
                                     std::span<const OdometrySample> odometry);

}  // namespace waymark::drive
