/// The logs of further sensors: the columns that their models need, and their readings on the clock
/// and in the frame of the drive. sensor_models.hpp adds them to the graph.
#pragma once

#include <span>
#include <string>

#include <waymark/core/base/error.hpp>
#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>
#include <waymark/tools/drive/coordinates/projection.hpp>

namespace waymark::drive {

/// Runs a step of a sensor. Its errors get the place of the sensor in the drive.yaml.
template <typename Step>
auto at_place_of(const std::string& place, const std::string& sensor, const Step& step) {
  try {
    return step();
  } catch (const PluginError& error) {
    throw PluginError(place + error.what(), error.type());
  } catch (const Error& error) {
    throw InputError(place + "sensor " + sensor + ": " + error.what());
  }
}

/// Adds the columns that the models need to the requests for their logs.
/// @throws InputError with the place in the drive.yaml for an unknown sensor or option, a missing
/// log, or a log that is not needed
void resolve_sensors(DriveDescription& description, const TypeRegistry& registry);

/// Returns the readings of a sensor on the scale of the drive, sorted (stable), with places in the frame
/// (place_columns.hpp). Headings from true east are turned into the frame by the meridian convergence at
/// the fix nearest in time; without fixes, at the origin of the frame.
/// @param request how the log is read, with the columns of the sensor
/// @param fixes sorted by stamp @param projection null for a local frame
/// @throws InputError for a log of seconds of week that would need a date, and for an impossible place
[[nodiscard]] SensorTable prepare_readings(const DriveLogs::Log& log, const LogRequest& request,
                                           TimeScale scale, std::span<const GeodeticFix> fixes,
                                           const Projection* projection, PrepareReport& report);

}  // namespace waymark::drive
