/// A drive with fewer nodes and fewer fixes, for what need not be exact: estimating its noise.
#pragma once

#include <vector>

#include <Eigen/Core>

#include <waymark/tools/drive/model/assemble.hpp>

namespace waymark::drive {

struct CoarseDrive {
  std::vector<Stamp> stamps;
  std::vector<Eigen::Vector3d> poses;  ///< of the start, at these nodes
  std::vector<Interval> intervals;     ///< mean twists between them
  std::vector<Fix> fixes;              ///< accepted ones; Fix::vertex is 1 + the node
  std::vector<Interval> motion;        ///< at each fix
};

/// Keeps accepted fixes at least `fix_period_s` apart per receiver (less by a tenth, for jitter), and merges
/// intervals between nodes without such a fix up to `node_period_s`, driving and standing ones apart. The
/// mean twist misses the exact motion by v a T^3 / 12 across for a yaw acceleration a: 1 cm for 10 m/s, 1
/// rad/s^2 and a quarter of a second.
[[nodiscard]] CoarseDrive coarsen(const PlacedDrive& placed, double fix_period_s = 7.5,
                                  double node_period_s = 0.25);

}  // namespace waymark::drive
