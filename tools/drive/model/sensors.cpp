#include <waymark/tools/drive/model/sensors.hpp>

#include <algorithm>

#include <fmt/format.h>

#include <waymark/tools/drive/logs/sensor_logs.hpp>

namespace waymark::drive {
namespace {

bool lie_apart(const SensorTable& readings, const DriveNodes& nodes) {
  return readings.size() > 0 && std::none_of(readings.stamps.begin(), readings.stamps.end(),
                                             [&](Stamp s) { return nearest_node(nodes, s).has_value(); });
}

}  // namespace

std::vector<std::string> add_sensors(std::span<const PreparedSensor> sensors, const DriveNodes& nodes,
                                     std::span<const Fix> fixes, const Eigen::Vector2d& antenna_m,
                                     const TypeRegistry& registry, Graph& graph) {
  std::vector<std::string> warnings;
  for (const PreparedSensor& sensor : sensors) {
    at_place_of(sensor.place, sensor.name, [&] {
      registry.make_sensor_model(sensor.name, sensor.options)
          ->build({nodes, fixes, antenna_m, sensor.readings}, graph);
      if (lie_apart(sensor.readings, nodes))
        warnings.push_back(
            fmt::format("{}sensor {}: none of its {} readings lies within the drive; is its "
                        "clock (time: scale, week, offset) right?",
                        sensor.place, sensor.name, sensor.readings.size()));
    });
  }
  return warnings;
}

}  // namespace waymark::drive
