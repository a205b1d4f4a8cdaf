/// Further sensors of a drive: their logs on the drive's clock and frame, their models into the graph.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>
#include <waymark/tools/drive/logs/projection.hpp>

namespace waymark::drive {

/// Tells the sensors' logs which columns their models ask for.
/// @throws InputError with the place in the drive.yaml: an unknown sensor or option, a log that is missing or
/// not wanted
void resolve_sensors(DriveConfig& config, const TypeRegistry& registry);

/// The readings of a sensor on the drive's scale, sorted (stable), headings from true east turned into the
/// frame by the meridian convergence at the fix nearest in time.
/// @param columns  what the values are
/// @param fixes    sorted by stamp, at least one
/// @throws InputError for a log of seconds of week that would need a date
[[nodiscard]] SensorTable prepare_readings(const DriveLogs::Log& log, std::span<const SensorColumn> columns,
                                           TimeScale scale, std::span<const GeodeticFix> fixes,
                                           const Projection& projection, PrepareReport& report);

/// Lets every sensor add its vertices and edges.
/// @param fixes  accepted ones
/// @return warnings: sensors none of whose readings lies within the drive
/// @throws InputError what a model throws, with the sensor's place in the drive.yaml
[[nodiscard]] std::vector<std::string> add_sensors(const DriveConfig& config, const PreparedDrive& drive,
                                                   const DriveNodes& nodes, std::span<const Fix> fixes,
                                                   const TypeRegistry& registry, Graph& graph);

}  // namespace waymark::drive
