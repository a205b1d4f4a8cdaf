#include <waymark/tools/live/estimator/window/window_setup.hpp>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <waymark/tools/drive/model/surroundings.hpp>

namespace waymark::live {
namespace {

drive::DriveFacts facts_of(const drive::DriveDescription& description, const FusionSetup& setup,
                           const Frame& frame) {
  drive::DriveFacts facts;
  for (const drive::OdometryConfig& odometry : description.odometry) facts.relative.push_back(odometry.name);
  if (!description.gnss.empty()) facts.antenna_m = description.gnss.front().antenna_m;
  facts.gap_noise_factor = description.timeline.gap_noise_factor;
  drive::PreparedDrive surroundings;
  surroundings.frame = frame;
  surroundings.scale = description.scale();
  facts.surroundings = std::make_shared<const drive::DriveSurroundings>(surroundings, std::vector<Fix>());
  for (std::size_t source = 0; source < description.gnss.size(); ++source) {
    const std::string name = drive::group_of(setup.settings, description.gnss[source].name);
    auto group = std::find_if(facts.absolute.begin(), facts.absolute.end(),
                              [&](const drive::AbsoluteGroup& known) { return known.name == name; });
    if (group == facts.absolute.end()) {
      group = facts.absolute.insert(facts.absolute.end(), drive::AbsoluteGroup{.name = name, .sources = {}});
      // The node of a fix that is early is not there yet.
      if (source < setup.delays_s.size()) group->time_offset_s = std::max(0.0, setup.delays_s[source]);
    }
    group->sources.push_back(static_cast<int>(source));
  }
  return facts;
}

std::vector<drive::PreparedSensor> sensors_of(const drive::DriveDescription& description) {
  std::vector<drive::PreparedSensor> sensors;
  for (const drive::SensorConfig& config : description.sensors) {
    drive::PreparedSensor sensor{.name = config.name, .options = config.options, .place = config.place};
    sensor.source = config.source_name();
    sensor.readings.columns = config.log ? config.log->request.readings.size() : 0;
    sensors.push_back(std::move(sensor));
  }
  return sensors;
}

}  // namespace

std::unique_ptr<Window> make_window(const drive::DriveDescription& description, const FusionSetup& setup,
                                    const Frame& frame, std::optional<drive::FirstPose> first_pose,
                                    const TypeRegistry& registry) {
  drive::DriveFacts facts = facts_of(description, setup, frame);
  facts.first_pose = std::move(first_pose);
  auto window = std::make_unique<Window>(facts, sensors_of(description), setup.settings, registry);
  window->keep_claimed(setup.claimed);
  return window;
}

}  // namespace waymark::live
