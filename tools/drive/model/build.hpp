/// Builds the graph of a placed drive: poses, odometry edges, further sensors, and the connection
/// to the fixes.
///
/// The steps visit the nodes in order of time, and each passes its part to one plugin. A growing
/// drive calls them with the new nodes and fixes: DriveNodes is a view, and may begin at any node.
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
/// @param sensors further ones, on the clock and in the frame of the drive; may be empty
/// @param settings from decided(), with the estimated noise among the options
/// @throws UsageError for an unknown modeling or option; errors of the plugins
[[nodiscard]] BuiltGraph build_graph(const PlacedDrive& placed, std::span<const PreparedSensor> sensors,
                                     const FusionSettings& settings, const TypeRegistry& registry);

}  // namespace waymark::drive
