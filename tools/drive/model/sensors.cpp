#include <waymark/tools/drive/model/sensors.hpp>

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/logs/streams.hpp>

namespace waymark::drive {
namespace {

/// Runs a step of a sensor; what is wrong with it is said with its place in the drive.yaml.
template <typename Step>
auto at_place_of(const SensorConfig& sensor, const Step& step) {
  try {
    return step();
  } catch (const Error& error) {
    throw InputError(fmt::format("{}sensor {}: {}", sensor.place, sensor.name, error.what()));
  }
}

const GeodeticFix& nearest_fix(std::span<const GeodeticFix> fixes, Stamp moment) {
  const auto after = std::lower_bound(fixes.begin(), fixes.end(), moment,
                                      [](const GeodeticFix& fix, Stamp stamp) { return fix.stamp < stamp; });
  if (after == fixes.begin()) return *after;
  const auto before = after - 1;
  if (after == fixes.end()) return *before;
  return seconds_between(before->stamp, moment) < seconds_between(moment, after->stamp) ? *before : *after;
}

/// Rows in order of time.
SensorTable sorted(const SensorTable& table) {
  std::vector<std::size_t> order(table.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return table.stamps[a] < table.stamps[b]; });
  SensorTable result;
  result.columns = table.columns;
  for (const std::size_t row : order) {
    result.stamps.push_back(table.stamps[row]);
    for (std::size_t c = 0; c < table.columns; ++c) result.values.push_back(table.at(row, c));
  }
  return result;
}

bool lie_apart(const SensorTable& readings, const DriveNodes& nodes) {
  return readings.size() > 0 && std::none_of(readings.stamps.begin(), readings.stamps.end(),
                                             [&](Stamp s) { return nearest_node(nodes, s).has_value(); });
}

}  // namespace

void resolve_sensors(DriveConfig& config, const TypeRegistry& registry) {
  for (SensorConfig& sensor : config.sensors) {
    at_place_of(sensor, [&] {
      const SensorModelType& type = registry.sensor_model(sensor.name);
      (void)registry.make_sensor_model(sensor.name, sensor.options);  // what is wrong shows before the work
      if (type.columns.empty() && sensor.log) throw InputError("takes no log; leave out 'file'");
      if (!type.columns.empty() && !sensor.log)
        throw InputError("needs a log: name it with 'file: ...' (`waymark info` lists its columns)");
      if (sensor.log) sensor.log->request.readings = type.columns;
    });
  }
}

SensorTable prepare_readings(const DriveLogs::Log& log, std::span<const SensorColumn> columns,
                             TimeScale scale, std::span<const GeodeticFix> fixes,
                             const Projection& projection, PrepareReport& report) {
  SensorTable table = log.data.readings;
  put_on_scale(table.stamps, log, scale, [](Stamp& stamp) -> Stamp& { return stamp; });
  add_log_report(log.data, report.sensor, report);
  table = sorted(table);
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (columns[c].sense != "ccw_from_east") continue;
    for (std::size_t row = 0; row < table.size(); ++row) {
      const GeodeticFix& fix = nearest_fix(fixes, table.stamps[row]);
      double& heading = table.values[row * table.columns + c];
      heading = grid_heading_from_true(
          heading, projection.to_grid({fix.latitude_deg, fix.longitude_deg}).convergence_rad);
    }
  }
  return table;
}

std::vector<std::string> add_sensors(const DriveConfig& config, const PreparedDrive& drive,
                                     const DriveNodes& nodes, std::span<const Fix> fixes,
                                     const TypeRegistry& registry, Graph& graph) {
  static const SensorTable kNone;
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < config.sensors.size(); ++i) {
    const SensorConfig& sensor = config.sensors[i];
    at_place_of(sensor, [&] {
      const SensorTable& readings = i < drive.sensors.size() ? drive.sensors[i] : kNone;
      registry.make_sensor_model(sensor.name, sensor.options)
          ->build({nodes, fixes, drive.antenna_m, readings}, graph);
      if (lie_apart(readings, nodes))
        warnings.push_back(
            fmt::format("{}sensor {}: none of its {} readings lies within the drive; is its "
                        "clock (time: scale, week, offset) right?",
                        sensor.place, sensor.name, readings.size()));
    });
  }
  return warnings;
}

}  // namespace waymark::drive
