#include <waymark/tools/live/estimator/rough_places.hpp>

#include <algorithm>
#include <utility>

#include <waymark/core/base/error.hpp>

namespace waymark::live {
namespace {

/// Takes the rows before a moment off a table. They are sorted by time.
SensorTable rows_before(Stamp moment, SensorTable& table) {
  const auto end = std::lower_bound(table.stamps.begin(), table.stamps.end(), moment);
  const auto numbers =
      table.values.begin() + (end - table.stamps.begin()) * static_cast<std::ptrdiff_t>(table.columns);
  SensorTable taken{{table.stamps.begin(), end}, {table.values.begin(), numbers}, table.columns};
  table.stamps.erase(table.stamps.begin(), end);
  table.values.erase(table.values.begin(), numbers);
  return taken;
}

}  // namespace

RoughPlaces::RoughPlaces(const drive::DriveDescription& description, const TypeRegistry& registry)
    : has_receiver_(!description.gnss.empty()) {
  for (std::size_t i = 0; i < description.sensors.size(); ++i) {
    const drive::SensorConfig& config = description.sensors[i];
    if (!config.log) continue;
    Sensor sensor{i, registry.make_sensor_model(config.name, config.options)};
    sensor.waiting.columns = config.log->request.readings.size();
    sensors_.push_back(std::move(sensor));
  }
}

std::string RoughPlaces::error_of(const SensorReading& reading) const {
  for (const Sensor& sensor : sensors_) {
    if (sensor.index != reading.sensor) continue;
    try {
      (void)sensor.model->rough_positions({{reading.stamp}, reading.values, sensor.waiting.columns});
    } catch (const InputError& error) {
      return error.what();
    }
  }
  return "";
}

void RoughPlaces::take(const SensorReading& reading) {
  if (!any()) return;
  for (Sensor& sensor : sensors_) {
    if (sensor.index != reading.sensor) continue;
    sensor.waiting.stamps.push_back(reading.stamp);
    sensor.waiting.values.insert(sensor.waiting.values.end(), reading.values.begin(), reading.values.end());
  }
}

std::vector<RoughPosition> RoughPlaces::before(Stamp moment) {
  std::vector<RoughPosition> positions;
  for (Sensor& sensor : sensors_) {
    const SensorTable rows = rows_before(moment, sensor.waiting);
    if (rows.stamps.empty()) continue;
    const std::vector<RoughPosition> own = sensor.model->rough_positions(rows);
    positions.insert(positions.end(), own.begin(), own.end());
  }
  std::stable_sort(positions.begin(), positions.end(),
                   [](const RoughPosition& a, const RoughPosition& b) { return a.stamp < b.stamp; });
  return positions;
}

}  // namespace waymark::live
