#include <waymark/tools/live/learning/lesson.hpp>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/clocks/clock_check.hpp>
#include <waymark/tools/drive/coordinates/projection.hpp>
#include <waymark/tools/drive/model/build.hpp>
#include <waymark/tools/drive/model/fuse.hpp>
#include <waymark/tools/drive/sensors/rough_fixes.hpp>
#include <waymark/tools/live/learning/noise_ahead.hpp>

namespace waymark::live {
namespace {

/// Gives sensors their readings, which are in the frame already, and without a receiver where they place the
/// vehicle.
void take_readings(std::vector<SensorTable> readings, const TypeRegistry& registry,
                   drive::PreparedDrive& drive) {
  for (std::size_t i = 0; i < drive.sensors.size(); ++i) {
    drive::PreparedSensor& sensor = drive.sensors[i];
    if (readings[i].size() == 0) continue;
    if (drive.receivers.empty() && drive.frame.zone != 0) {
      drive::DriveLogs::Log log;
      log.scale = drive.scale;
      log.rough = registry.make_sensor_model(sensor.name, sensor.options)->rough_positions(readings[i]);
      sensor.rough = drive::rough_fixes(log, drive.scale, drive::Projection(drive.frame));
    }
    sensor.readings = std::move(readings[i]);
  }
}

/// Returns the mean over the nodes.
Eigen::Matrix3d mean_of(const std::vector<drive::PoseSpread>& spread) {
  Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
  for (const drive::PoseSpread& of : spread) mean += of.covariance / static_cast<double>(spread.size());
  return mean;
}

}  // namespace

Lesson learn(const DriveSoFar& so_far, const drive::DriveDescription& description,
             const drive::FusionSettings& stated, const std::set<std::string>& suspects,
             const TypeRegistry& registry, const std::function<void()>& between) {
  Lesson lesson;
  lesson.length_s = so_far.length_s();
  try {
    drive::PreparedDrive drive = drive::prepare_on_one_clock(so_far.logs(description), description,
                                                             drive::ClocksApart::tell, suspects);
    take_readings(so_far.readings(), registry, drive);
    drive::ModeledDrive modeled = drive::Fusion(drive, registry, between).estimated(stated);
    lesson.noise = noise_ahead(std::move(modeled.noise), lesson.length_s);
    lesson.setup.settings =
        drive::with_noise(drive::without_noise(std::move(modeled.settings), lesson.noise), lesson.noise);
    lesson.spread = mean_of(lesson.noise.spread);
    lesson.noise.spread.clear();
    for (const drive::AbsoluteGroup& group : drive::groups_of(modeled.placed, lesson.setup.settings))
      for (const int source : group.sources) lesson.setup.claimed[source] = group.claimed;
    lesson.setup.delays_s = std::move(modeled.placed.time_offsets_s);
    lesson.warnings = std::move(modeled.placed.warnings);
    lesson.left_out = std::move(modeled.placed.left_out);
  } catch (const InputError& error) {
    lesson.failure = error.what();
  }
  return lesson;
}

std::string in_words(const drive::NoiseEstimate& noise) {
  std::string words;
  for (const drive::NoiseParameter& parameter : noise.parameters)
    if (parameter.observed())
      words += fmt::format("{}{} {:.3g}{}{}", words.empty() ? "" : ", ", parameter.name(), parameter.value,
                           parameter.unit.empty() ? "" : " ", parameter.unit);
  return words;
}

}  // namespace waymark::live
