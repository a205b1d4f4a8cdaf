#include <waymark/tools/drive/description/config.hpp>

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>

#include <fmt/format.h>

#include <waymark/core/base/angle.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/channels.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/drive/description/log_config.hpp>
#include <waymark/tools/drive/description/yaml_section.hpp>

namespace waymark::drive {
namespace {

constexpr std::array<std::string_view, 2> kGapPolicies{"bridge", "error"};
constexpr std::array<std::string_view, 2> kInitialGuesses{"anchored", "dead_reckoning"};
constexpr std::array<std::string_view, 2> kNoises{"estimate", "stated"};
constexpr std::array<std::string_view, 4> kSwitch{"on", "off", "true", "false"};
constexpr std::array kSwitchValues{true, false, true, false};
constexpr NumberRule kRate{1e-3, 1000, "a rate in Hz from 0.001 to 1000"};
constexpr NumberRule kSnap{0, kLargestSnap, "seconds from 0 to 0.05"};
constexpr NumberRule kFactor{1, std::numeric_limits<double>::max(), "a number not below 1"};
constexpr NumberRule kAngle{std::numeric_limits<double>::min(), 180, "degrees above 0, up to 180"};
constexpr NumberRule kWithhold{0, 1e9, "0 (none) or a whole number from 2"};

/// What a gnss entry says beyond its log.
struct Receiver {
  Eigen::Vector2d antenna_m{0, 0};
  double period_s = 0;
  double delay_s = 0;
  int withhold_every = 0;

  friend bool operator==(const Receiver&, const Receiver&) = default;
};

void read_time(const YamlSection& top, DriveConfig& config) {
  const auto time = top.section("time", {"scale", "from", "to"});
  if (!time) return;
  if (const auto scale = time->read_word("scale", kTimeScaleWords)) {
    config.time_scale = *time_scale_from_string(kTimeScaleWords[*scale]);
    config.time_scale_stated = true;
  }
  time->read("from", config.from_s, kNotNegative);
  time->read("to", config.to_s, kPositive);
  if (config.to_s && *config.to_s <= config.from_s.value_or(0)) time->fail("to", "must lie after 'from'");
}

/// 32, "32N" or "32S"; a plain number is north.
int read_zone(const YamlSection& frame) {
  std::string text;
  frame.read("utm_zone", text);
  bool north = true;
  if (!text.empty() && (text.back() == 'N' || text.back() == 'S')) {
    north = text.back() == 'N';
    text.pop_back();
  }
  int zone = 0;
  for (const char c : text) {
    const bool good = c >= '0' && c <= '9' && zone < 100;
    zone = good ? 10 * zone + (c - '0') : 100;
  }
  if (zone < 1 || zone > 60) frame.fail_value("utm_zone", "a zone such as 32N or 56S");
  return north ? zone : -zone;
}

void read_frame(const YamlSection& top, DriveConfig& config) {
  const auto frame = top.section("frame", {"utm_zone", "origin"});
  if (!frame) return;
  if (frame->has("utm_zone")) config.utm_zone = read_zone(*frame);
  if (!frame->has("origin")) return;
  if (!config.utm_zone) frame->fail("origin", "needs a stated utm_zone: it counts from that zone's corner");
  Eigen::Vector2d origin;
  frame->read("origin", origin);
  config.utm_origin = origin;
}

/// Options that only a plugin can check: name and value as they stand, with their places.
void read_options(const YamlSection& section, std::string_view key, const std::string& name,
                  std::map<std::string, std::string>& options, DriveConfig& config) {
  const auto free = section.free_section(key);
  if (!free) return;
  for (const std::string& option : free->keys()) {
    free->read(option, options[option]);
    config.places[name + option] = free->place(option);
  }
}

std::vector<YAML::Node> entries_of(const YAML::Node& node) {
  std::vector<YAML::Node> entries;
  if (node.IsSequence()) {
    for (const auto& entry : node) entries.push_back(entry);
  } else {
    entries.push_back(node);
  }
  return entries;
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

/// Whether a log's columns name more than whole odometry has: then it holds channels.
bool names_channels(const YamlSection& section) {
  const auto columns = section.free_section("columns");
  if (!columns) return false;
  const std::vector<std::string> keys = columns->keys();
  return std::any_of(keys.begin(), keys.end(), [](const std::string& key) {
    return key != "time" && key != "speed" && key != "yaw_rate";
  });
}

void read_odometry(const YamlSection& top, DriveConfig& config) {
  if (!top.has("odometry")) throw InputError(top.place() + "'odometry' is missing");
  const YamlSection section(top.node("odometry"), "odometry", top.file(),
                            log_keys({"parts", "rate", "speed_from", "yaw_rate_from", "gyro", "vehicle",
                                      "speed_delay", "yaw_rate_delay", "model", "options"}));
  const auto read_log = [&](const YamlSection& from, bool in_channels) {
    LogRequest request;
    request.stream = StreamKind::odometry;
    if (in_channels) request.readings = formats::odometry_channels();
    config.odometry.push_back(read_log_config(from, request, config.folder, config.time_scale));
  };
  if (section.has("parts")) {
    if (section.has("file")) section.fail("file", "give either 'file' or 'parts'");
    for (const YAML::Node& entry : entries_of(section.node("parts")))
      read_log(YamlSection(entry, "odometry.parts", top.file(), log_keys()), true);
    if (config.odometry.empty()) section.fail("parts", "at least one log is needed");
  } else {
    read_log(section, names_channels(section));
  }
  read_assembly(section, config.assembly);
  section.read("speed_delay", config.speed_delay_s, kAnyNumber);
  section.read("yaw_rate_delay", config.yaw_rate_delay_s, kAnyNumber);
  section.read("model", config.odometry_model);
  if (section.has("model")) config.places["odometry.model"] = section.place("model");
  read_options(section, "options", "odometry.options.", config.odometry_options, config);
}

Receiver read_receiver(const YamlSection& section) {
  Receiver receiver;
  section.read("antenna", receiver.antenna_m);
  section.read("period", receiver.period_s, kNotNegative);
  section.read("delay", receiver.delay_s, kAnyNumber);
  section.read("withhold_every", receiver.withhold_every, kWithhold);
  if (receiver.withhold_every == 1) section.fail_value("withhold_every", kWithhold.words);
  return receiver;
}

std::optional<LogConfig> read_velocity(const YamlSection& section, const DriveConfig& config) {
  if (!section.has("velocity")) return std::nullopt;
  LogRequest request;
  request.readings = formats::velocity_channels();
  return read_log_config(YamlSection(section.node("velocity"), "gnss.velocity", section.file(), log_keys()),
                         request, config.folder, config.time_scale);
}

void read_gnss(const YamlSection& top, DriveConfig& config) {
  if (!top.has("gnss")) throw InputError(top.place() + "'gnss' is missing");
  const std::vector<YAML::Node> entries = entries_of(top.node("gnss"));
  if (entries.empty()) top.fail("gnss", "at least one log is needed");
  std::optional<Receiver> first;
  for (const YAML::Node& entry : entries) {
    const YamlSection section(
        entry, "gnss", top.file(),
        log_keys({"accuracy", "velocity", "antenna", "period", "delay", "withhold_every"}));
    LogRequest request;
    request.source = static_cast<int>(config.gnss.size());
    GnssConfig log{read_log_config(section, request, config.folder, config.time_scale),
                   read_velocity(section, config)};
    config.gnss.push_back(std::move(log));
    const Receiver receiver = read_receiver(section);
    if (first && !(receiver == *first))
      throw InputError(section.place() +
                       "gnss: all logs must state the same antenna, period, delay and withhold_every");
    first = receiver;
  }
  config.antenna_m = first->antenna_m;
  config.gnss_period_s = first->period_s;
  config.gnss_delay_s = first->delay_s;
  config.withhold_every = first->withhold_every;
}

void read_truth(const YamlSection& top, DriveConfig& config) {
  if (!top.has("truth")) return;
  const YamlSection section(top.node("truth"), "truth", top.file(), log_keys({"accuracy", "reference"}));
  LogRequest request;
  request.stream = StreamKind::truth;
  config.truth = read_log_config(section, request, config.folder, config.time_scale);
  section.read("reference", config.truth_reference_m);
}

void read_gate(const YamlSection& top, DriveConfig& config) {
  const auto gate = top.section(
      "gate", {"enabled", "max_angle_deg", "max_displacement_m", "chord_s", "max_chord_s", "min_chord_m"});
  if (!gate) return;
  gate->read("enabled", config.gate.enabled);
  config.gate_stated = true;
  double max_angle_deg = config.gate.max_angle_rad / kDegree;
  gate->read("max_angle_deg", max_angle_deg, kAngle);
  if (gate->has("max_angle_deg")) config.gate.max_angle_rad = max_angle_deg * kDegree;
  gate->read("max_displacement_m", config.gate.max_displacement_m, kPositive);
  gate->read("chord_s", config.gate.chord_s, kPositive);
  gate->read("max_chord_s", config.gate.max_chord_s, kPositive);
  gate->read("min_chord_m", config.gate.min_chord_m, kPositive);
  if (config.gate.max_chord_s < config.gate.chord_s)
    throw InputError(fmt::format("{}gate: max_chord_s ({}) must not be below chord_s ({})", gate->place(),
                                 config.gate.max_chord_s, config.gate.chord_s));
}

void read_timeline(const YamlSection& top, DriveConfig& config) {
  top.read("snap", config.timeline.snap_s, kSnap);
  const auto gap = top.section("gap", {"longer_than", "policy", "noise_factor"});
  if (!gap) return;
  gap->read("longer_than", config.timeline.gap_s, kPositive);
  if (const auto policy = gap->read_word("policy", kGapPolicies))
    config.timeline.gap_policy = *policy == 0 ? GapPolicy::bridge : GapPolicy::error;
  gap->read("noise_factor", config.timeline.gap_noise_factor, kFactor);
}

void read_modeling(const YamlSection& top, DriveConfig& config) {
  if (!top.has("modeling")) return;
  config.places["modeling"] = top.place("modeling");
  if (!top.node("modeling").IsMap()) return top.read("modeling", config.modeling);
  const YamlSection modeling = *top.section("modeling", {"name", "loss", "options"});
  modeling.read("name", config.modeling);
  modeling.read("loss", config.loss);
  if (modeling.has("loss")) config.places["modeling.loss"] = modeling.place("loss");
  read_options(modeling, "options", "modeling.options.", config.modeling_options, config);
}

/// `calibration: on`, `off`, or the states one by one.
void read_calibration(const YamlSection& top, DriveConfig& config) {
  if (!top.has("calibration")) return;
  config.calibration_stated = true;
  if (top.node("calibration").IsMap())
    return read_options(top, "calibration", "calibration.", config.calibration, config);
  const std::size_t word = *top.read_word("calibration", kSwitch);
  if (kSwitchValues[word]) config.calibration = default_calibration();
}

void read_sensors(const YamlSection& top, DriveConfig& config) {
  if (!top.has("sensors")) return;
  for (const YAML::Node& entry : entries_of(top.node("sensors"))) {
    const YamlSection section(entry, "sensors", top.file(), log_keys({"name", "options"}));
    SensorConfig sensor;
    sensor.place = section.place();
    section.read("name", sensor.name);
    if (sensor.name.empty()) throw InputError(sensor.place + "sensors: 'name' is missing");
    LogRequest request;
    request.stream = StreamKind::sensor;
    if (section.has("file")) sensor.log = read_log_config(section, request, config.folder, config.time_scale);
    read_options(section, "options", "sensors." + sensor.name + ".", sensor.options, config);
    config.sensors.push_back(std::move(sensor));
  }
}

/// Files lie beside the drive.yaml.
void read_plugins(const YamlSection& top, DriveConfig& config) {
  if (!top.has("plugins")) return;
  const auto beside = std::filesystem::path(config.path).parent_path();
  for (const YAML::Node& entry : entries_of(top.node("plugins"))) {
    if (!entry.IsScalar()) top.fail_value("plugins", "a list of plugin files");
    const std::string plugin = entry.Scalar();
    config.plugins.push_back(is_plugin_file(plugin) ? (beside / plugin).lexically_normal().string() : plugin);
  }
}

void read_folder(const YamlSection& top, const std::string& data_folder, DriveConfig& config) {
  std::string stated = ".";
  top.read("folder", stated);
  const std::filesystem::path beside = std::filesystem::path(config.path).parent_path();
  config.folder = data_folder.empty() ? (beside / stated).lexically_normal().string() : data_folder;
}

}  // namespace

DriveConfig parse_drive_config(const std::string& text, const std::string& path,
                               const std::string& data_folder) {
  YAML::Node root;
  try {
    root = YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw InputError(fmt::format("{}:{}:{}: no valid YAML: {}", path, error.mark.line + 1,
                                 error.mark.column + 1, error.msg));
  }
  const YamlSection top(root, "", path,
                        {"name", "folder", "time", "frame", "odometry", "gnss", "truth", "gate", "gap",
                         "snap", "initial_guess", "modeling", "calibration", "noise", "sensors", "plugins"});
  DriveConfig config;
  config.path = path;
  config.name = std::filesystem::path(path).stem().string();
  top.read("name", config.name);
  read_folder(top, data_folder, config);
  read_time(top, config);
  read_frame(top, config);
  read_odometry(top, config);
  read_gnss(top, config);
  read_truth(top, config);
  read_gate(top, config);
  read_timeline(top, config);
  if (const auto start = top.read_word("initial_guess", kInitialGuesses))
    config.start.method = *start == 0 ? StartMethod::anchored : StartMethod::dead_reckoning;
  read_modeling(top, config);
  read_calibration(top, config);
  if (const auto noise = top.read_word("noise", kNoises)) config.estimates_noise = *noise == 0;
  read_sensors(top, config);
  read_plugins(top, config);
  return config;
}

bool is_drive_file(std::string_view path) {
  return path.ends_with(".yaml") || path.ends_with(".yml");
}

bool is_plugin_file(std::string_view plugin) {
  const std::filesystem::path path(plugin);
  return path.has_parent_path() || path.has_extension();
}

std::map<std::string, std::string> default_calibration() {
  return {{"gyro_bias", "random_walk"}, {"speed_scale", "random_walk"}, {"time_offset", "constant"}};
}

DriveConfig load_drive_config(const std::string& path, const std::string& data_folder) {
  return parse_drive_config(formats::read_text_file(path), path, data_folder);
}

}  // namespace waymark::drive
