/// The noise of the minutes ahead, by that of the drive so far.
///
/// A drive comes into other streets: its noise in the next minutes is like that of the last ones, not the same.
/// The search takes the noise as one for the whole drive, and so a minute of fixes seems to tell it well. Here
/// each minute counts as a sample of a noise that varies from minute to minute by a part of the deviation that
/// its prior gives it from drive to drive. With few minutes the values lie between those of the search and the
/// priors; with many they are those of the search.
#pragma once

#include <waymark/tools/drive/estimation/noise.hpp>

namespace waymark::live {

/// @param noise with its curvature, from a whole search @param length_s of the drive so far
[[nodiscard]] drive::NoiseEstimate noise_ahead(drive::NoiseEstimate noise, double length_s);

/// Returns the deviation of a parameter in the minutes ahead.
/// @param deviation of the drive so far, above 0 @param of_prior its deviation without a drive
[[nodiscard]] double deviation_ahead(double deviation, double of_prior, double length_s);

}  // namespace waymark::live
