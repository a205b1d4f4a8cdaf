#include <fmt/format.h>

#include <waymark/core/error.hpp>
#include <waymark/formats/text_file.hpp>
#include <waymark/tools/drive/prepare.hpp>

namespace waymark {
namespace {

/// Not every format knows sensors, and a plugin's reader may be wrong.
void check_readings(const SensorTable& readings, const LogConfig& log) {
  const std::size_t columns = log.request.readings.size();
  if (readings.size() > 0 && readings.columns == columns &&
      readings.values.size() == readings.size() * columns)
    return;
  throw InputError(fmt::format("{}{}: format '{}' gives no readings of a sensor; use csv", log.place,
                               log.file, log.format));
}

DriveLogs::Log read_log(const LogConfig& log, const LogReaderLookup& find_reader) {
  const LogReader* reader = find_reader(log.format);
  if (reader == nullptr)
    throw InputError(
        fmt::format("{}unknown log format '{}'; `waymark info` lists those there are; a plugin that brings "
                    "it is loaded with --plugin",
                    log.place, log.format));
  const std::string text = read_text_file(log.file);
  DriveLogs::Log result{reader->read(text, log.file, log.request), log.request.time_scale, log.file};
  if (log.request.stream == StreamKind::sensor) check_readings(result.data.readings, log);
  return result;
}

}  // namespace

DriveLogs read_drive_logs(const DriveConfig& config, const LogReaderLookup& find_reader) {
  DriveLogs logs;
  if (!config.odometry) throw InputError(fmt::format("{}: no odometry log is named", config.path));
  logs.odometry = read_log(*config.odometry, find_reader);
  for (const LogConfig& log : config.gnss) logs.gnss.push_back(read_log(log, find_reader));
  if (config.truth) logs.truth.push_back(read_log(*config.truth, find_reader));
  for (const SensorConfig& sensor : config.sensors)
    logs.sensors.push_back(sensor.log ? read_log(*sensor.log, find_reader) : DriveLogs::Log{});
  return logs;
}

PreparedDrive load_drive(const DriveConfig& config, const LogReaderLookup& find_reader) {
  return prepare_drive(read_drive_logs(config, find_reader), config);
}

}  // namespace waymark
