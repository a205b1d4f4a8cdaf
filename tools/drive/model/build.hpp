/// The graph over a placed drive: poses, odometry edges, further sensors, and what ties them
/// to the fixes.
///
/// The steps walk the nodes in order of time, and each hands its part to one plugin. A drive
/// that grows calls them with the nodes and fixes that are new: DriveNodes is a view, and may
/// begin at any node.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/drive/model/place.hpp>

namespace waymark::drive {

/// A graph at its initial guess.
struct BuiltGraph {
  Graph graph;                        ///< the pose of node i has the id i + 1
  std::vector<std::string> warnings;  ///< of the sensors
};

/// Builds the graph of the accepted fixes.
/// @param sensors   further ones, on the clock and in the frame of the drive; may be empty
/// @param settings  decided, with the estimated noise among the options
/// @throws UsageError for an unknown modeling or option; what the plugins throw
[[nodiscard]] BuiltGraph build_graph(const PlacedDrive& placed, std::span<const PreparedSensor> sensors,
                                     const FusionSettings& settings, const TypeRegistry& registry);

}  // namespace waymark::drive
