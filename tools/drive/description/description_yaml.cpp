#include <waymark/tools/drive/description/description_yaml.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <map>

#include <fmt/format.h>

#include <waymark/core/base/angle.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/channels.hpp>
#include <waymark/tools/drive/description/drive_file.hpp>
#include <waymark/tools/drive/description/frame_entries.hpp>
#include <waymark/tools/drive/description/log_config.hpp>
#include <waymark/tools/drive/description/source_entries.hpp>

namespace waymark::drive {
namespace {

constexpr std::array<std::string_view, 2> kGapPolicies{"bridge", "error"};
constexpr NumberRule kRate{1e-3, 1000, "a rate in Hz from 0.001 to 1000"};
constexpr double kLeastPeriod = 1e-3;
constexpr NumberRule kSnap{0, kLargestSnap, "seconds from 0 to 0.05"};
constexpr NumberRule kLater{0, 1e9, "seconds from 0 to 1e9"};
constexpr NumberRule kSmoothing{0, 60, "0 (none), or seconds up to 60"};
constexpr NumberRule kPeriod{0, 1e6, "0 (all), or seconds from 0.001 to 1e6"};
constexpr NumberRule kFactor{1, std::numeric_limits<double>::max(), "a number not below 1"};
constexpr NumberRule kWithhold{0, 1e9, "0 (none) or a whole number from 2"};

void read_time(const YamlSection& top, DriveDescription& drive) {
  const auto time = top.section("time", {"scale", "from", "to"});
  if (!time) return;
  if (const auto scale = time->read_word("scale", kTimeScaleWords))
    drive.time_scale = time_scale_from_string(kTimeScaleWords[*scale]);
  time->read("from", drive.from_s, kLater);
  time->read("to", drive.to_s, kLater);
  if (drive.to_s && *drive.to_s <= drive.from_s.value_or(0)) time->fail("to", "must be greater than 'from'");
}

void read_frame(const YamlSection& top, DriveDescription& drive) {
  const auto frame = top.section("frame", {"utm_zone", "origin"});
  if (!frame) return;
  const ZoneAndOrigin read = read_zone_and_origin(*frame);
  drive.utm_zone = read.zone;
  drive.utm_origin = read.origin;
}

/// Returns the frame in which logs may give positions in metres.
std::optional<Frame> metric_frame(const DriveDescription& drive) {
  return frame_of({drive.utm_zone, drive.utm_origin});
}

void read_assembly(const YamlSection& section, OdometryAssembly& assembly) {
  section.read("rate", assembly.rate_hz, kRate);
  if (const auto word = section.read_word("speed_from", kSpeedSources))
    assembly.speed_from = kSpeedSources[*word];
  if (const auto word = section.read_word("yaw_rate_from", kYawRateSources))
    assembly.yaw_rate_from = kYawRateSources[*word];
  if (const auto gyro = section.section("gyro", {"axis"})) {
    if (const auto word = gyro->read_word("axis", kGyroAxes)) assembly.gyro_axis = kGyroAxes[*word];
  }
  const auto vehicle = section.section(
      "vehicle", {"track_width", "wheelbase", "steering_ratio", "metres_per_tick", "tick_range"});
  if (!vehicle) return;
  vehicle->read("track_width", assembly.track_width_m, kPositive);
  vehicle->read("wheelbase", assembly.wheelbase_m, kPositive);
  vehicle->read("steering_ratio", assembly.steering_ratio, kPositive);
  vehicle->read("metres_per_tick", assembly.metres_per_tick, kPositive);
  vehicle->read("tick_range", assembly.tick_range, kPositive);
}

/// Tells whether a log has channels: its columns name more than complete odometry has.
bool names_channels(const YamlSection& section) {
  const auto columns = section.free_section("columns");
  if (!columns) return false;
  const std::vector<std::string> keys = columns->keys();
  return std::any_of(keys.begin(), keys.end(), [](const std::string& key) {
    return key != "time" && key != "speed" && key != "yaw_rate";
  });
}

OdometryConfig read_odometry(const YamlSection& section, std::string name, const DriveDescription& drive) {
  OdometryConfig odometry;
  odometry.name = std::move(name);
  const auto read_log = [&](const YamlSection& from, bool in_channels) {
    LogRequest request;
    request.stream = StreamKind::odometry;
    if (in_channels) request.readings = formats::odometry_channels();
    odometry.logs.push_back(read_log_config(from, request, drive.folder, drive.scale()));
  };
  if (section.has("parts")) {
    if (section.has("file")) section.fail("file", "give either 'file' or 'parts'");
    for (const YAML::Node& entry : entries_of(section.node("parts")))
      read_log(YamlSection(entry, "odometry.parts", section.file(), log_keys()), true);
    if (odometry.logs.empty()) section.fail("parts", "at least one log is needed");
  } else {
    read_log(section, names_channels(section));
  }
  read_assembly(section, odometry.assembly);
  section.read("speed_delay", odometry.speed_delay_s, kSeconds);
  section.read("yaw_rate_delay", odometry.yaw_rate_delay_s, kSeconds);
  for (const std::string_view key : {"speed_delay", "yaw_rate_delay"})
    if (section.has(key)) odometry.delay_place = section.place(key);
  section.read("nodes", odometry.gives_nodes);
  return odometry;
}

std::optional<LogConfig> read_velocity(const YamlSection& section, const DriveDescription& drive) {
  if (!section.has("velocity")) return std::nullopt;
  LogRequest request;
  request.readings = formats::velocity_channels();
  return read_log_config(YamlSection(section.node("velocity"), "gnss.velocity", section.file(), log_keys()),
                         request, drive.folder, drive.scale());
}

GnssConfig read_gnss(const YamlSection& section, std::string name, const DriveDescription& drive) {
  LogRequest request;
  request.source = static_cast<int>(drive.gnss.size());
  request.metric_frame = metric_frame(drive);
  GnssConfig gnss{read_log_config(section, request, drive.folder, drive.scale())};
  gnss.velocity = read_velocity(section, drive);
  gnss.name = std::move(name);
  section.read("antenna", gnss.antenna_m);
  gnss.antenna_is_stated = section.has("antenna");
  section.read("period", gnss.period_s, kPeriod);
  if (gnss.period_s > 0 && gnss.period_s < kLeastPeriod) section.fail_value("period", kPeriod.words);
  section.read("delay", gnss.delay_s, kSeconds);
  if (section.has("delay")) gnss.delay_place = section.place("delay");
  section.read("smoothing", gnss.smoothing_s, kSmoothing);
  section.read("withhold_every", gnss.withhold_every, kWithhold);
  if (gnss.withhold_every == 1) section.fail_value("withhold_every", kWithhold.words);
  section.read("withheld", gnss.withheld);
  return gnss;
}

/// Reads latitude and longitude, or a position in the frame.
void read_place(const YamlSection& section, StatedPose& pose) {
  if (section.has("position")) section.read("position", pose.position_m.emplace());
  if (!section.has("latitude") && !section.has("longitude")) return;
  if (pose.position_m || !section.has("latitude") || !section.has("longitude"))
    section.fail(section.has("latitude") ? "latitude" : "longitude",
                 "a place is latitude and longitude together, or position");
  GeodeticPoint& place = pose.place.emplace();
  section.read("latitude", place.latitude_deg, {-90, 90, "degrees from -90 to 90"});
  section.read("longitude", place.longitude_deg, {-180, 360, "degrees from -180 to 360"});
}

void read_first_pose(const YamlSection& top, DriveDescription& drive) {
  const auto section = top.section(
      "first_pose", {"position", "latitude", "longitude", "heading_deg", "sigma", "heading_sigma_deg"});
  if (!section) return;
  StatedPose& pose = drive.first_pose.emplace();
  read_place(*section, pose);
  std::optional<double> heading_deg;
  section->read("heading_deg", heading_deg, kAnyNumber);
  if (heading_deg) pose.heading_rad = std::remainder(*heading_deg, 360) * kDegree;
  section->read("sigma", pose.sigma_m, kSigma);
  double sigma_deg = pose.sigma_rad / kDegree;
  section->read("heading_sigma_deg", sigma_deg, kSigma);
  pose.sigma_rad = sigma_deg * kDegree;
  if (!pose.place && !pose.position_m && !pose.heading_rad)
    throw InputError(section->place() +
                     "first_pose: state a place (position, or latitude and longitude) or heading_deg");
}

void read_truth(const YamlSection& top, DriveDescription& drive) {
  if (!top.has("truth")) return;
  const YamlSection section(top.node("truth"), "truth", top.file(),
                            log_keys({"accuracy", "frame", "reference"}));
  LogRequest request;
  request.stream = StreamKind::truth;
  request.metric_frame = metric_frame(drive);
  drive.truth = read_log_config(section, request, drive.folder, drive.scale());
  section.read("reference", drive.truth_reference_m);
}

void read_timeline(const YamlSection& top, DriveDescription& drive) {
  top.read("snap", drive.timeline.snap_s, kSnap);
  const auto gap = top.section("gap", {"longer_than", "policy", "noise_factor"});
  if (!gap) return;
  gap->read("longer_than", drive.timeline.gap_s, kPositive);
  drive.states_gap = gap->has("longer_than");
  if (const auto policy = gap->read_word("policy", kGapPolicies))
    drive.timeline.gap_policy = *policy == 0 ? GapPolicy::bridge : GapPolicy::error;
  gap->read("noise_factor", drive.timeline.gap_noise_factor, kFactor);
}

SensorConfig read_sensor(const YamlSection& section, std::string kind, std::string source,
                         const DriveDescription& drive) {
  SensorConfig sensor;
  sensor.place = section.place();
  sensor.name = std::move(kind);
  sensor.source = std::move(source);
  LogRequest request;
  request.stream = StreamKind::sensor;
  if (section.has("file")) sensor.log = read_log_config(section, request, drive.folder, drive.scale());
  if (section.has("antenna")) {
    Eigen::Vector2d antenna;
    section.read("antenna", antenna);
    sensor.options["antenna_x"] = shortest(antenna.x());
    sensor.options["antenna_y"] = shortest(antenna.y());
  }
  if (const auto options = section.free_section("options")) {
    for (const std::string& option : options->keys()) options->read_option(option, sensor.options[option]);
  }
  return sensor;
}

/// Reads the heading of an absolute source that gives poses, from its own log unless another is named: the
/// sensor `heading`, named after its source.
std::optional<SensorConfig> read_heading(const YamlSection& section, const std::string& source,
                                         const DriveDescription& drive) {
  if (!section.has("heading")) return std::nullopt;
  YAML::Node heading = YAML::Clone(section.node("heading"));
  for (const char* key : {"file", "format", "separator", "time"})
    if (heading.IsMap() && !heading[key] && section.has(key)) heading[key] = section.node(key);
  const YamlSection own(heading, "gnss.heading", section.file(), log_keys({"options"}));
  return read_sensor(own, "heading", fmt::format("{}_heading", source), drive);
}

/// Adds every source of the file. @throws InputError for a name that two of them have
void read_sources(const YamlSection& top, DriveDescription& drive) {
  std::map<std::string, std::string> places;
  for (const SourceEntry& entry : source_entries(top)) {
    const YamlSection& section = entry.section;
    const auto [known, is_new] = places.try_emplace(entry.name, section.place());
    if (!is_new)
      throw InputError(section.place() + "there is a source '" + entry.name + "' already (" +
                       known->second.substr(0, known->second.rfind(": ")) + "); give them different names");
    if (entry.kind == kOdometryKind) {
      drive.odometry.push_back(read_odometry(section, entry.name, drive));
    } else if (entry.kind == kGnssKind) {
      drive.gnss.push_back(read_gnss(section, entry.name, drive));
      if (auto heading = read_heading(section, entry.name, drive))
        drive.sensors.push_back(*std::move(heading));
    } else {
      drive.sensors.push_back(read_sensor(section, entry.kind, entry.name, drive));
    }
  }
  if (drive.odometry.empty()) throw InputError(top.place() + "'odometry' is missing");
  if (drive.gnss.empty() && drive.sensors.empty() && !drive.first_pose)
    throw InputError(
        top.place() +
        "'gnss' is missing; a drive without it needs a sensor that sees known places, or 'first_pose'");
  if (std::count_if(drive.odometry.begin(), drive.odometry.end(),
                    [](const OdometryConfig& odometry) { return odometry.gives_nodes; }) > 1)
    throw InputError(top.place() + "'nodes: true' is stated for two sources; nodes come from one");
}

/// Relative names of files are relative to the drive.yaml.
void read_plugins(const YamlSection& top, DriveDescription& drive) {
  if (!top.has("plugins")) return;
  const auto beside = std::filesystem::path(drive.path).parent_path();
  for (const YAML::Node& entry : entries_of(top.node("plugins"))) {
    if (!entry.IsScalar()) top.fail_value("plugins", "a list of plugin files");
    const std::string plugin = entry.Scalar();
    drive.plugins.push_back(is_plugin_file(plugin) ? (beside / plugin).lexically_normal().string() : plugin);
  }
}

void read_folder(const YamlSection& top, const std::string& data_folder, DriveDescription& drive) {
  std::string stated = ".";
  top.read("folder", stated);
  const std::filesystem::path beside = std::filesystem::path(drive.path).parent_path();
  drive.folder = data_folder.empty() ? (beside / stated).lexically_normal().string() : data_folder;
}

}  // namespace

DriveDescription read_description(const YamlSection& top, const std::string& data_folder) {
  DriveDescription drive;
  drive.path = top.file();
  drive.name = std::filesystem::path(drive.path).stem().string();
  top.read("name", drive.name);
  top.read("environment", drive.environment);
  read_folder(top, data_folder, drive);
  read_time(top, drive);
  read_frame(top, drive);
  read_first_pose(top, drive);
  read_sources(top, drive);
  read_truth(top, drive);
  read_timeline(top, drive);
  read_plugins(top, drive);
  return drive;
}

}  // namespace waymark::drive
