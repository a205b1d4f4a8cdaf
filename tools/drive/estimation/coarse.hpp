/// A drive with fewer nodes and fewer fixes. It is precise enough to estimate the noise.
#pragma once

#include <waymark/core/graph/graph.hpp>
#include <waymark/tools/drive/model/place.hpp>

namespace waymark::drive {

struct CoarseDrive {
  PlacedDrive drive;
  std::vector<PreparedSensor> sensors;  ///< with the readings that are kept
};

/// Keeps accepted fixes at least `fix_period_s` apart per receiver (a tenth less, for jitter).
/// Merges intervals between nodes without such a fix up to `node_period_s`, driving and standing
/// ones separately, as long as their mean twist ends within 1 mm of where they end, or within what the
/// noise of the yaw rate readings leads astray in that time: for a yaw acceleration a it misses by v a T^3 / 12
/// across, so that turns keep more nodes than straight ways, and noise of q rad/sqrt(s) by v q sqrt(T^3 / 12).
/// The process noise is additive in time and way, and is the same for any merging. The counts of the gate
/// stay those of the whole drive. Of the readings of each sensor those are kept that lie nearest to a node
/// that is kept, and every quarter of a second there is such a node if there is a reading.
[[nodiscard]] CoarseDrive coarsen(const PlacedDrive& placed, std::span<const PreparedSensor> sensors,
                                  double fix_period_s = 7.5, double node_period_s = 1);

/// Takes the poses of a graph that was built of the drive: the nodes are its first vertices.
void keep_poses(const Graph& graph, CoarseDrive& coarse);

/// Returns a sensor with readings that lie a period apart (a tenth less, for jitter). Rows within a millisecond
/// are one reading.
[[nodiscard]] PreparedSensor thinned(const PreparedSensor& sensor, double period_s);

/// Returns the middle of a coarse drive, of a length or a little more.
[[nodiscard]] CoarseDrive middle_of(const CoarseDrive& whole, double length_s);

/// Returns windows of a long drive at equal distances in time, with gaps of the odometry between them, so that
/// what is estimated from it costs the same for an hour and a day. Of stops of more than 20 minutes the rest is no
/// part of that time, nor of the sample, nor is what drives less than 50 m between two of them. The whole if that
/// is most of it, if there are no fixes, or if several odometries measured it. Two hours tell the parameters of the
/// noise to a tenth. (From 25 minutes of an hour, the positions of simulated drives were 1 to 10 % worse.)
[[nodiscard]] CoarseDrive sample_of(CoarseDrive whole, std::size_t windows = 12, double window_s = 600);

}  // namespace waymark::drive
