/// The motion that each of several relative sources measured, between nodes of the drive.
#pragma once

#include <span>
#include <vector>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>
#include <waymark/tools/drive/nodes/timeline.hpp>

namespace waymark::drive {

/// What a relative source measured without a silence in between.
struct MotionRun {
  std::size_t source = 0;           ///< index of the relative source
  std::vector<std::size_t> nodes;   ///< ascending, counted from the first of the drive
  std::vector<Interval> intervals;  ///< the motion from each of these nodes to the next
  /// Whether a source before it joins each of these nodes too. The track of this source then runs beside
  /// the nodes (track_sigma_option in core/drive/modeling.hpp).
  std::vector<char> beside{};
};

/// Returns what the sources measured. The first one joins all nodes. Another one joins the nodes
/// nearest to its own samples, so that no reading counts twice, and all nodes where those before it are
/// silent. Speed and yaw rate are means of the samples, with straight lines between these. Where
/// every source is silent, the first one has the bridged intervals of the timeline.
/// @param relative as PreparedDrive::relative @param fixes of the timeline, for the grid scale
[[nodiscard]] std::vector<MotionRun> motion_runs(const Timeline& timeline,
                                                 std::span<const PreparedOdometry> relative,
                                                 std::span<const Fix> fixes);

}  // namespace waymark::drive
