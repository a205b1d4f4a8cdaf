/// A drive with fewer nodes and fewer fixes. It is precise enough to estimate the noise.
#pragma once

#include <waymark/tools/drive/model/place.hpp>

namespace waymark::drive {

struct CoarseDrive {
  PlacedDrive drive;
  std::vector<PreparedSensor> sensors;  ///< with the readings that are kept
};

/// Keeps accepted fixes at least `fix_period_s` apart per receiver (a tenth less, for jitter).
/// Merges intervals between nodes without such a fix up to `node_period_s`, driving and standing
/// ones separately. For a yaw acceleration a, the mean twist misses the exact motion by v a T^3 /
/// 12 across: 1 cm for 10 m/s, 1 rad/s^2 and a quarter of a second. The counts of the gate stay
/// those of the whole drive. Of the readings of each sensor those are kept that lie nearest to a node
/// that is kept, and every `node_period_s` there is such a node if there is a reading.
[[nodiscard]] CoarseDrive coarsen(const PlacedDrive& placed, std::span<const PreparedSensor> sensors,
                                  double fix_period_s = 7.5, double node_period_s = 0.25);

}  // namespace waymark::drive
