#include <waymark/tools/drive/sensors/sensor_models.hpp>

#include <algorithm>

#include <fmt/format.h>

#include <waymark/tools/drive/sensors/sensor_logs.hpp>

namespace waymark::drive {
namespace {

bool lie_apart(const SensorTable& readings, const DriveNodes& nodes) {
  return readings.size() > 0 && std::none_of(readings.stamps.begin(), readings.stamps.end(),
                                             [&](Stamp s) { return nearest_node(nodes, s).has_value(); });
}

}  // namespace

SensorModels::SensorModels(std::span<const PreparedSensor> sensors, const FusionSettings& settings,
                           const TypeRegistry& registry) {
  for (const PreparedSensor& sensor : sensors) {
    at_place_of(sensor.place, sensor.name, [&] {
      models_.push_back(
          {sensor.name, registry.make_sensor_model(sensor.name, options_of(sensor, settings)),
           loss_of_source(settings, sensor.source, registry, registry.sensor_model(sensor.name).loss)});
    });
  }
}

void SensorModels::check_drive(std::span<const PreparedSensor> sensors, std::span<const Fix> fixes) const {
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    at_place_of(sensors[i].place, sensors[i].name,
                [&] { models_[i].model->check_drive(fixes, sensors[i].readings); });
  }
}

void SensorModels::extend(std::size_t index, const std::string& place, const SensorInput& input,
                          Graph& graph) {
  at_place_of(place, models_[index].name, [&] { models_[index].model->extend(input, graph); });
}

Options options_of(const PreparedSensor& sensor, const FusionSettings& settings) {
  Options options = sensor.options;
  const auto stated = settings.sources.find(sensor.source);
  if (stated != settings.sources.end())
    options.insert(stated->second.options.begin(), stated->second.options.end());
  return options;
}

std::vector<std::string> warnings_of_sensors_apart(std::span<const PreparedSensor> sensors,
                                                   const DriveNodes& nodes) {
  std::vector<std::string> warnings;
  for (const PreparedSensor& sensor : sensors) {
    if (!lie_apart(sensor.readings, nodes)) continue;
    warnings.push_back(
        fmt::format("{}sensor {}: none of its {} readings lies within the drive; is its "
                    "clock (time: scale, week, offset) right?",
                    sensor.place, sensor.name, sensor.readings.size()));
  }
  return warnings;
}

}  // namespace waymark::drive
