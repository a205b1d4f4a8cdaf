#include <waymark/tools/drive/sensors/sensor_logs.hpp>

#include <algorithm>
#include <numeric>
#include <utility>

#include <waymark/tools/drive/logs/streams.hpp>
#include <waymark/tools/drive/sensors/place_columns.hpp>

namespace waymark::drive {
namespace {

const GeodeticFix& nearest_fix(std::span<const GeodeticFix> fixes, Stamp moment) {
  const auto after = std::lower_bound(fixes.begin(), fixes.end(), moment,
                                      [](const GeodeticFix& fix, Stamp stamp) { return fix.stamp < stamp; });
  if (after == fixes.begin()) return *after;
  const auto before = after - 1;
  if (after == fixes.end()) return *before;
  return seconds_between(before->stamp, moment) < seconds_between(moment, after->stamp) ? *before : *after;
}

/// Returns where the vehicle was: the fix nearest in time; without fixes, the origin of the frame.
GeodeticPoint place_at(Stamp moment, std::span<const GeodeticFix> fixes, const Projection& projection) {
  if (fixes.empty()) return projection.to_geodetic({0, 0});
  const GeodeticFix& fix = nearest_fix(fixes, moment);
  return {fix.latitude_deg, fix.longitude_deg};
}

/// Sorts rows by time.
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

}  // namespace

void resolve_sensors(DriveDescription& description, const TypeRegistry& registry) {
  for (SensorConfig& sensor : description.sensors) {
    at_place_of(sensor.place, sensor.name, [&] {
      const SensorModelType& type = registry.sensor_model(sensor.name);
      sensor.options = with_files_below(description.folder, std::move(sensor.options), type.options);
      // errors are found before the work
      (void)registry.make_sensor_model(sensor.name, sensor.options);
      if (type.columns.empty() && sensor.log) throw InputError("takes no log; leave out 'file'");
      if (!type.columns.empty() && !sensor.log)
        throw InputError("needs a log: name it with 'file: ...' (`waymark info` lists its columns)");
      if (!sensor.log) return;
      sensor.log->request.readings = type.columns;
      check_place_columns(sensor.log->request);
    });
  }
}

SensorTable prepare_readings(const DriveLogs::Log& log, const LogRequest& request, TimeScale scale,
                             std::span<const GeodeticFix> fixes, const Projection* projection,
                             PrepareReport& report) {
  SensorTable table = log.data.readings;
  put_on_scale(table.stamps, log, scale, [](Stamp& stamp) -> Stamp& { return stamp; });
  add_log_report(log.data, report.sensor, report);
  table = sorted(table);
  const std::vector<SensorColumn>& columns = request.readings;
  place_in_frame(request, projection, table);
  if (projection == nullptr) return table;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (columns[c].sense != "ccw_from_east") continue;
    for (std::size_t row = 0; row < table.size(); ++row) {
      double& heading = table.values[row * table.columns + c];
      const GeodeticPoint place = place_at(table.stamps[row], fixes, *projection);
      heading = grid_heading_from_true(heading, projection->to_grid(place).convergence_rad);
    }
  }
  return table;
}

}  // namespace waymark::drive
