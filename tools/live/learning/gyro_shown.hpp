/// What the readings of a gyro show of it before the fixes do.
#pragma once

#include <deque>

#include <waymark/core/drive/sample.hpp>

namespace waymark::live {

/// Returns the density of the white noise of a yaw rate, rad^2/s, by its median second difference: a vehicle turns
/// smoothly, noise does not. It is that of the readings alone; the heading errs by that at least. 0 for readings that
/// are fewer than a hundred or rarer than 10 Hz, between which the vehicle turns as it likes.
[[nodiscard]] double white_noise_of(const std::deque<OdometrySample>& odometry);

/// Returns how far the bias of a gyro walks in a second, rad/s/sqrt(s), by what it reads in one stop after another.
/// Stops count as far as their readings tell the bias: with few of them it is the usual one.
[[nodiscard]] double bias_walk_of(const std::deque<OdometrySample>& odometry);

}  // namespace waymark::live
