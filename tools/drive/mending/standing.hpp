/// Finds times in which a vehicle stands although its speed reads noise without a sign.
#pragma once

#include <span>
#include <vector>

#include <waymark/core/drive/sample.hpp>

namespace waymark::drive {

/// Samples [first, last] of a vehicle that stands.
struct Standing {
  std::size_t first = 0;
  std::size_t last = 0;
};

/// Finds them. Speeds without a sign that are noise about 0 add up to a way that nobody drives: 0.1 m/s to
/// 24 m in 5 minutes. Where all readings of 3 s are below 0.5 m/s and change from sample to sample by more
/// than 0.4 of their mean, the vehicle stands: one that creeps changes its speed smoothly. (The mean of
/// difference of two independent normal numbers without sign is 0.83 of their mean.) There is none if a speed is
/// negative, because such noise adds up to nothing, and with fewer than 5 samples per second.
/// @param odometry sorted by stamp
[[nodiscard]] std::vector<Standing> find_standing(std::span<const OdometrySample> odometry);

}  // namespace waymark::drive
