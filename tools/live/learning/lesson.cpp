#include <waymark/tools/live/learning/lesson.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/clocks/clock_check.hpp>
#include <waymark/tools/drive/coordinates/projection.hpp>
#include <waymark/tools/drive/model/build.hpp>
#include <waymark/tools/drive/model/fuse.hpp>
#include <waymark/tools/drive/sensors/rough_fixes.hpp>
#include <waymark/tools/live/learning/bias_walk.hpp>
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

/// A search has taken more steps than a lesson may.
struct Exhausted {};

/// What a lesson may take: however a search goes astray, the estimate does not wait for it. In steps, not in time, so
/// that a replay learns the same. A step takes some microseconds for each second of the drive (MEASUREMENTS.md).
class Allowance {
 public:
  Allowance(double length_s, std::function<void()> between)
      : steps_(static_cast<std::size_t>((kFirst_s + kPerSecond * length_s) / std::max(length_s, 1.0))),
        between_(std::move(between)) {}
  void step() {
    if (steps_ == 0) throw Exhausted();
    --steps_;
    if (between_) between_();
  }

 private:
  static constexpr double kFirst_s = 1e6;  // steps times seconds of the drive
  static constexpr double kPerSecond = 2000;
  std::size_t steps_;
  std::function<void()> between_;
};

/// Returns the mean over the nodes.
Eigen::Matrix3d mean_of(const std::vector<drive::PoseSpread>& spread) {
  Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
  for (const drive::PoseSpread& of : spread) mean += of.covariance / static_cast<double>(spread.size());
  return mean;
}

/// @throws Exhausted by what is called between the steps
Lesson lesson_of(const DriveSoFar& so_far, const LessonTask& task, const TypeRegistry& registry,
                 const std::function<void()>& between) {
  Lesson lesson;
  lesson.length_s = so_far.length_s();
  try {
    drive::PreparedDrive drive = drive::prepare_on_one_clock(so_far.logs(task.description), task.description,
                                                             drive::ClocksApart::tell, task.suspects);
    take_readings(so_far.readings(), registry, drive);
    drive::ModeledDrive modeled = drive::Fusion(drive, registry, between).estimated(task.stated);
    if (task.walk_is_open)
      take_bias_walk(drive.sensors, task.description.odometry.front().name, registry, between, modeled);
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

}  // namespace

Lesson learn(DriveSoFar so_far, const LessonTask& task, const TypeRegistry& registry,
             const std::function<void()>& between) {
  constexpr int kMostHalves = 2;
  for (int halves = 0; halves <= kMostHalves; ++halves) {
    Allowance allowance(so_far.length_s(), between);
    try {
      return lesson_of(so_far, task, registry, [&] { allowance.step(); });
    } catch (const Exhausted&) {
      so_far.keep_last(0.5 * so_far.length_s());
    }
  }
  Lesson lesson;
  lesson.length_s = so_far.length_s();
  lesson.failure = "the search comes to no end in the steps that it may take";
  lesson.left_out = task.suspects;
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
