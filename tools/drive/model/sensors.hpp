/// Adds the further sensors of a drive to its graph.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>

namespace waymark::drive {

/// Calls every sensor to add its vertices and edges.
/// @param fixes accepted ones
/// @param antenna_m GNSS antenna in the body frame
/// @return warnings: sensors without a reading within the drive
/// @throws InputError from a model, with the place of the sensor in the drive.yaml
[[nodiscard]] std::vector<std::string> add_sensors(std::span<const PreparedSensor> sensors,
                                                   const DriveNodes& nodes, std::span<const Fix> fixes,
                                                   const Eigen::Vector2d& antenna_m,
                                                   const TypeRegistry& registry, Graph& graph);

}  // namespace waymark::drive
