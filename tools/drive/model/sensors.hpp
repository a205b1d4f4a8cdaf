/// The further sensors' part of a drive's graph.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>

namespace waymark::drive {

/// Lets every sensor add its vertices and edges.
/// @param fixes    accepted ones
/// @param antenna_m  GNSS antenna in the body frame
/// @return warnings: sensors none of whose readings lies within the drive
/// @throws InputError what a model throws, with the sensor's place in the drive.yaml
[[nodiscard]] std::vector<std::string> add_sensors(std::span<const PreparedSensor> sensors,
                                                   const DriveNodes& nodes, std::span<const Fix> fixes,
                                                   const Eigen::Vector2d& antenna_m,
                                                   const TypeRegistry& registry, Graph& graph);

}  // namespace waymark::drive
