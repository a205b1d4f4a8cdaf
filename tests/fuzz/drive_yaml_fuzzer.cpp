// A drive.yaml of any bytes. Its logs are made here, so that everything up to the prepared drive is reached.
#include <cmath>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/log_readers.hpp>
#include <waymark/plugins/builtin.hpp>
#include <waymark/tools/drive/description/drive_file.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>
#include <waymark/tools/drive/sensors/sensor_logs.hpp>
#include <waymark/types_se2/register.hpp>

#include "invariants.hpp"
#include "targets.hpp"

namespace waymark_fuzz {
namespace {

using namespace waymark;

constexpr int kSamples = 101;  // 10 s at 10 Hz

Stamp stamp_at(double seconds) {
  return Stamp::from_seconds(1e9 + seconds);
}

drive::DriveLogs::Log log_of(const drive::LogConfig& config) {
  drive::DriveLogs::Log log;
  log.scale = config.request.time_scale;
  log.file = config.file;
  return log;
}

drive::DriveLogs::Log odometry_log(const drive::LogConfig& config) {
  drive::DriveLogs::Log log = log_of(config);
  const std::size_t columns = config.request.readings.size();
  log.data.readings.columns = columns;
  for (int i = 0; i < kSamples; ++i) {
    log.data.odometry.push_back({stamp_at(0.1 * i), 5, 0.1});
    if (columns == 0) continue;
    log.data.readings.stamps.push_back(stamp_at(0.1 * i));
    log.data.readings.values.insert(log.data.readings.values.end(), columns, 0.5);
  }
  if (columns > 0) log.data.odometry.clear();
  return log;
}

drive::DriveLogs::Log readings_log(const drive::LogConfig& config) {
  drive::DriveLogs::Log log = log_of(config);
  log.data.readings.columns = config.request.readings.size();
  for (int i = 0; i < 9; ++i) {
    log.data.readings.stamps.push_back(stamp_at(i));
    log.data.readings.values.insert(log.data.readings.values.end(), config.request.readings.size(), 0.5);
  }
  return log;
}

drive::DriveLogs::Log gnss_log(const drive::GnssConfig& config) {
  drive::DriveLogs::Log log = log_of(config);
  for (int i = 1; i < 10; ++i) {
    GeodeticFix fix;
    fix.stamp = stamp_at(i);
    fix.latitude_deg = 50 + 1e-5 * i;
    fix.longitude_deg = 15;
    fix.source = config.request.source;
    fix.line = static_cast<std::size_t>(i);
    log.data.fixes.push_back(fix);
  }
  return log;
}

drive::DriveLogs logs_of(const drive::DriveDescription& description) {
  drive::DriveLogs logs;
  for (const drive::OdometryConfig& source : description.odometry) {
    auto& parts = logs.odometry.emplace_back();
    for (const drive::LogConfig& log : source.logs) parts.push_back(odometry_log(log));
  }
  for (const drive::GnssConfig& source : description.gnss) {
    logs.gnss.push_back(gnss_log(source));
    logs.velocity.push_back(source.velocity ? readings_log(*source.velocity) : drive::DriveLogs::Log());
  }
  if (description.truth) {
    drive::DriveLogs::Log& log = logs.truth.emplace_back(log_of(*description.truth));
    for (int i = 0; i < 10; ++i) {
      GeodeticTruth truth;
      truth.stamp = stamp_at(i);
      truth.latitude_deg = 50;
      truth.longitude_deg = 15;
      log.data.truth.push_back(truth);
    }
  }
  for (const drive::SensorConfig& sensor : description.sensors)
    logs.sensors.push_back(sensor.log ? readings_log(*sensor.log) : drive::DriveLogs::Log());
  return logs;
}

void check_drive(const drive::PreparedDrive& drive) {
  if (drive.odometry.size() < 2) broken("fewer than two samples of odometry");
  for (const Fix& fix : drive.fixes)
    if (!fix.position.allFinite() || !fix.covariance.allFinite()) broken("a fix is not finite");
  for (const TruthPose& pose : drive.truth)
    if (!pose.position.allFinite()) broken("truth is not finite");
  for (const OdometrySample& sample : drive.odometry)
    if (!std::isfinite(sample.speed_mps) || !std::isfinite(sample.yaw_rate_radps))
      broken("odometry is not finite");
}

TypeRegistry drive_registry() {
  TypeRegistry registry;
  register_core_types(registry);
  register_se2_types(registry);
  plugins::register_builtin_plugins(registry);
  formats::register_log_readers(registry);
  return registry;
}

}  // namespace

void fuzz_drive_yaml(std::string_view, const std::uint8_t* bytes, std::size_t size) {
  static const TypeRegistry registry = drive_registry();
  const std::string text(reinterpret_cast<const char*>(bytes), size);
  try {
    drive::DriveFile file = drive::parse_drive_file(text, "fuzz.yaml", "/nowhere");
    drive::resolve_sensors(file.description, registry);
    check_drive(drive::prepare_drive(logs_of(file.description), file.description));
  } catch (const InputError&) {
    // refused
  } catch (const UsageError&) {
    // refused
  }
}

}  // namespace waymark_fuzz
