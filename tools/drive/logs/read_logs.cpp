#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/suggest.hpp>
#include <waymark/formats/logs/channels.hpp>
#include <waymark/formats/text/hash.hpp>
#include <waymark/tools/drive/logs/open_log.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>
#include <waymark/tools/drive/logs/shared_weeks.hpp>
#include <waymark/tools/drive/sensors/sensor_logs.hpp>

namespace waymark::drive {
namespace {

/// A file that cannot be read is wrong where it is named.
void require_readable(const std::string& place, const std::string& file) {
  if (::access(file.c_str(), R_OK) != 0)
    throw InputError(
        fmt::format("{}{}: cannot read: {}", place, file, std::generic_category().message(errno)));
}

/// Not every format supports sensors, and the reader of a plugin may be wrong.
void check_readings(const SensorTable& readings, const LogConfig& log) {
  const std::size_t columns = log.request.readings.size();
  if (readings.size() > 0 && readings.columns == columns &&
      readings.values.size() == readings.size() * columns)
    return;
  throw InputError(fmt::format("{}{}: format '{}' has no readings of a sensor; use csv or candump", log.place,
                               log.file, log.format));
}

std::vector<LogReaderType> readers_of(const TypeRegistry& registry) {
  std::vector<LogReaderType> readers;
  for (const Registered<LogReaderType>& entry : registry.log_readers()) readers.push_back(entry.type);
  return readers;
}

LogReaderType named_reader(const LogConfig& log, const std::vector<LogReaderType>& readers) {
  std::vector<std::string_view> names;
  for (const LogReaderType& reader : readers) {
    if (reader.name == log.format) return reader;
    names.push_back(reader.name);
  }
  throw InputError(
      fmt::format("{}unknown log format '{}'{}; `waymark info` lists all; load the plugin of a "
                  "format with --plugin",
                  log.place, log.format, did_you_mean(log.format, names)));
}

/// Reads the text of the files that belong to the log. For a folder of KITTI oxts the time stamps
/// are beside it, by the layout of the data set.
void read_companions(const LogConfig& log, LogRequest& request, std::vector<InputFile>& inputs,
                     std::vector<std::string>& notes) {
  std::map<std::string, std::vector<std::string>> companions = log.companions;
  const std::filesystem::path beside = std::filesystem::path(log.file).parent_path() / "timestamps.txt";
  std::error_code unknown;  // opening the log will report the error
  if (std::filesystem::is_directory(log.file, unknown) && !companions.contains("timestamps") &&
      std::filesystem::exists(beside, unknown)) {
    companions["timestamps"] = {beside.string()};
    notes.push_back(
        fmt::format("{}: time stamps are on the scale of {} (not stated)", log.file, beside.string()));
  }
  for (const auto& [key, paths] : companions) {
    for (const std::string& path : paths) {
      require_readable(log.place, path);
      CompanionFile file = formats::read_companion(path);
      if (log.companions.contains(key))
        inputs.push_back({path, "fnv1a64:" + formats::fnv1a64_hex(file.text)});
      request.companions[key].push_back(std::move(file));
    }
  }
}

/// Returns the reader that recognises a log. A table that none does is one of Waymark's tables all the same:
/// its reader knows best what is wrong with it.
formats::Recognised recognised(const std::string& file, const std::vector<LogReaderType>& readers) {
  try {
    return formats::recognise_log(file, readers);
  } catch (const InputError&) {
    constexpr std::array<std::string_view, 2> kTables{".csv", ".tsv"};
    const std::string ending = std::filesystem::path(file).extension().string();
    const auto csv = std::find_if(readers.begin(), readers.end(),
                                  [](const LogReaderType& reader) { return reader.name == "csv"; });
    if (csv == readers.end() || std::find(kTables.begin(), kTables.end(), ending) == kTables.end()) throw;
    return {*csv, {}};
  }
}

/// Takes a log that is in memory. Odometry may come in parts, as its columns tell.
DriveLogs::Log take_memory_log(const LogConfig& log) {
  LogRequest request = log.request;
  const auto has = [&](const char* column) { return log.samples->columns.contains(column); };
  const bool complete = has("speed") && has("yaw_rate");
  if (request.stream == StreamKind::odometry && !complete && log.samples->columns.size() > 0)
    request.readings = formats::odometry_channels();
  return {read_memory_log(*log.samples, log.file, request),
          request.time_scale,
          log.file,
          {{log.file, fingerprint(*log.samples)}}};
}

DriveLogs::Log read_log(const LogConfig& log, const TypeRegistry& registry, const LogWatch& watch) {
  if (log.samples) return take_memory_log(log);
  const bool is_opened_to_choose = log.format == "auto";
  if (is_opened_to_choose) require_readable(log.place, log.file);
  ChosenReader chosen = choose_reader(log, registry);
  if (!is_opened_to_choose) require_readable(log.place, log.file);
  std::vector<InputFile> inputs{{log.file, {}}};
  inputs.insert(inputs.end(), chosen.inputs.begin(), chosen.inputs.end());
  const formats::ReadProgress progress = [&](std::uint64_t done, std::uint64_t size) {
    if (watch) watch(log.file, done, size);
  };
  formats::Fnv1a64 hash;
  const auto seen = [&](std::string_view piece) { hash.add(piece); };
  DriveLogs::Log result{formats::read_log_file(*chosen.type.reader, log.file, chosen.request, progress, seen),
                        chosen.request.time_scale,
                        log.file,
                        {}};
  inputs.front().fingerprint = "fnv1a64:" + hash.hex();
  result.inputs = std::move(inputs);
  result.data.notes.insert(result.data.notes.begin(), chosen.notes.begin(), chosen.notes.end());
  if (log.request.stream == StreamKind::sensor) check_readings(result.data.readings, log);
  return result;
}

/// Reads the log of one of several sources. If it holds nothing, the others go on without it.
/// @param nothing set to the reason in that case
DriveLogs::Log read_log_of_many(const LogConfig& log, const TypeRegistry& registry, const LogWatch& watch,
                                std::string& nothing) {
  try {
    return read_log(log, registry, watch);
  } catch (const EmptyLogError& error) {
    nothing = error.what();
    DriveLogs::Log empty;
    empty.scale = log.request.time_scale;
    empty.file = log.file;
    empty.data.readings.columns = log.request.readings.size();
    return empty;
  }
}

}  // namespace

ChosenReader choose_reader(const LogConfig& log, const TypeRegistry& registry) {
  const std::vector<LogReaderType> readers = readers_of(registry);
  ChosenReader chosen;
  chosen.request = log.request;
  if (log.format == "auto") {
    const formats::Recognised found = recognised(log.file, readers);
    chosen.type = found.reader;
    if (chosen.type.name != "csv")
      chosen.notes.push_back(
          fmt::format("{}: read as '{}': {}", log.file, chosen.type.name, found.why.evidence));
  } else {
    chosen.type = named_reader(log, readers);
  }
  if (log.request.stream == StreamKind::odometry && !chosen.type.whole_odometry)
    chosen.request.readings = formats::odometry_channels();
  read_companions(log, chosen.request, chosen.inputs, chosen.notes);
  return chosen;
}

DriveLogs read_drive_logs(const DriveDescription& description, const TypeRegistry& registry,
                          const LogWatch& watch) {
  DriveLogs logs;
  if (description.odometry.empty())
    throw InputError(fmt::format("{}: no odometry log is named", description.path));
  for (const OdometryConfig& source : description.odometry) {
    std::vector<DriveLogs::Log>& parts = logs.odometry.emplace_back();
    const bool one_of_many = description.odometry.size() > 1 && source.logs.size() == 1;
    std::string unheard;  // prepare_odometry() tells that a source has no sample
    for (const LogConfig& log : source.logs)
      parts.push_back(one_of_many ? read_log_of_many(log, registry, watch, unheard)
                                  : read_log(log, registry, watch));
    std::vector<ReadLog> read;
    for (std::size_t i = 0; i < parts.size(); ++i) read.push_back({&parts[i], &source.logs[i]});
    share_weeks(read);
  }
  for (const GnssConfig& log : description.gnss) {
    std::string nothing;
    logs.gnss.push_back(description.gnss.size() > 1 ? read_log_of_many(log, registry, watch, nothing)
                                                    : read_log(log, registry, watch));
    if (!nothing.empty()) logs.warnings.push_back(fmt::format("{}; {} is left out", nothing, log.name));
    logs.velocity.push_back(log.velocity ? read_log(*log.velocity, registry, watch) : DriveLogs::Log{});
    if (log.velocity)
      share_weeks(
          std::array{ReadLog{&logs.gnss.back(), &log}, ReadLog{&logs.velocity.back(), &*log.velocity}});
  }
  if (description.truth) logs.truth.push_back(read_log(*description.truth, registry, watch));
  for (const SensorConfig& sensor : description.sensors) {
    logs.sensors.push_back(sensor.log ? read_log(*sensor.log, registry, watch) : DriveLogs::Log{});
    if (!sensor.log || !description.gnss.empty()) continue;
    DriveLogs::Log& log = logs.sensors.back();
    log.rough = at_place_of(sensor.place, sensor.name, [&] {
      return registry.make_sensor_model(sensor.name, sensor.options)->rough_positions(log.data.readings);
    });
  }
  return logs;
}

PreparedDrive load_drive(DriveDescription description, const TypeRegistry& registry, const LogWatch& watch) {
  resolve_sensors(description, registry);
  return prepare_drive(read_drive_logs(description, registry, watch), description);
}

std::vector<TruthPose> load_truth(const DriveDescription& description, const Frame& frame,
                                  const TypeRegistry& registry, const LogWatch& watch) {
  if (!description.truth) throw InputError(description.path + ": has no 'truth' section");
  return prepare_truth(read_log(*description.truth, registry, watch), description.scale(), frame);
}

}  // namespace waymark::drive
