/// Finds times in which a vehicle stands although its speed reads noise that adds up to a way.
#pragma once

#include <span>
#include <vector>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/drive/mending/sample_range.hpp>

namespace waymark::drive {

/// Samples of a vehicle that stands.
struct Standing : SampleRange {};

/// Finds them. Speeds without a sign that are noise about 0 add up to a way that nobody drives: 0.1 m/s to
/// 24 m in 5 minutes. All readings of 3 s are slower than 0.5 m/s, seldom exactly 0, and change from sample to
/// sample by more than 0.4 of their mean size. (The mean difference of two independent normal numbers without
/// sign is 0.83 of their mean.) A vehicle that creeps looks alike, so the fixes decide: the way that the
/// readings add up to is more than three of their sigmas, and they move by less than 0.4 of it. Noise with a sign
/// adds up to nothing. There is none with fewer than 5 samples per second.
/// @param odometry sorted by stamp
/// @param fixes sorted by stamp; those of the first receiver that are not withheld are used
[[nodiscard]] std::vector<Standing> find_standing(std::span<const OdometrySample> odometry,
                                                  std::span<const Fix> fixes);

}  // namespace waymark::drive
