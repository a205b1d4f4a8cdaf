#include <waymark/tools/drive/description/settings_yaml.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <waymark/core/base/angle.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/description/source_entries.hpp>

namespace waymark::drive {
namespace {

constexpr std::array<std::string_view, 2> kInitialGuesses{"anchored", "dead_reckoning"};
constexpr std::array<std::string_view, 2> kNoises{"estimate", "stated"};
constexpr std::array<std::string_view, 4> kSwitch{"on", "off", "true", "false"};
constexpr std::array kSwitchValues{true, false, true, false};
constexpr NumberRule kAngle{std::numeric_limits<double>::min(), 180, "degrees above 0, up to 180"};

/// Reads options of a registered type: name and value as they are, with their places. Names and
/// ranges are checked when the type is made.
void read_options(const YamlSection& section, std::string_view key, const std::string& name, Options& options,
                  Places& places) {
  const auto free = section.free_section(key);
  if (!free) return;
  for (const std::string& option : free->keys()) {
    free->read_option(option, options[option]);
    places.of[name + option] = free->place(option);
  }
}

/// Returns whether there is a gate.
bool read_gate(const YamlSection& top, GateOptions& options) {
  const auto gate = top.section(
      "gate", {"enabled", "max_angle_deg", "max_displacement_m", "chord_s", "max_chord_s", "min_chord_m"});
  if (!gate) return false;
  bool enabled = true;
  gate->read("enabled", enabled);
  options.enabled = enabled;
  double max_angle_deg = options.max_angle_rad / kDegree;
  gate->read("max_angle_deg", max_angle_deg, kAngle);
  if (gate->has("max_angle_deg")) options.max_angle_rad = max_angle_deg * kDegree;
  gate->read("max_displacement_m", options.max_displacement_m, kPositive);
  gate->read("chord_s", options.chord_s, kPositive);
  gate->read("max_chord_s", options.max_chord_s, kPositive);
  gate->read("min_chord_m", options.min_chord_m, kPositive);
  if (options.max_chord_s < options.chord_s)
    throw InputError(fmt::format("{}gate: max_chord_s ({}) must not be below chord_s ({})", gate->place(),
                                 options.max_chord_s, options.chord_s));
  return true;
}

void read_modeling(const YamlSection& top, FusionSettings& settings, Places& places) {
  if (!top.has("modeling")) return;
  if (!top.node("modeling").IsMap()) return top.read("modeling", settings.modeling);
  const YamlSection modeling = *top.section("modeling", {"name", "loss", "options"});
  modeling.read("name", settings.modeling);
  modeling.read("loss", settings.loss);
  if (modeling.has("loss")) places.of["modeling.loss"] = modeling.place("loss");
  read_options(modeling, "options", "modeling.options.", settings.modeling_options, places);
}

/// Reads `calibration: on`, `off`, or single states.
void read_calibration(const YamlSection& top, FusionSettings& settings, Places& places) {
  if (!top.has("calibration")) return;
  Options& calibration = settings.calibration.emplace();
  if (top.node("calibration").IsMap())
    return read_options(top, "calibration", "calibration.", calibration, places);
  const std::size_t word = *top.read_word("calibration", kSwitch);
  if (kSwitchValues[word]) calibration = default_calibration();
}

/// Reads the loss of the measurements of a source. @param place of the keys in Places
void read_loss(const YamlSection& section, const std::string& place, SourceSettings& source, Places& places) {
  if (!section.has("loss")) return;
  section.read("loss", source.loss.emplace());
  places.of[place + ".loss"] = section.place("loss");
}

/// Reads what an odometry states for itself. @param place of the keys in Places
void read_relative(const YamlSection& section, const std::string& place, SourceSettings& source,
                   Places& places) {
  section.read("model", source.model);
  if (section.has("model")) places.of[place + ".model"] = section.place("model");
  read_options(section, "options", place + ".options.", source.options, places);
  read_options(section, "calibration", place + ".calibration.", source.calibration, places);
  read_loss(section, place, source, places);
}

/// Reads what a receiver states for itself.
void read_absolute(const YamlSection& section, const std::string& place, const GateOptions& gate,
                   SourceSettings& source, Places& places) {
  section.read("common", source.common);
  if (section.has("common")) places.of[place + ".common"] = section.place("common");
  read_options(section, "calibration", place + ".calibration.", source.calibration, places);
  GateOptions own = gate;
  if (read_gate(section, own)) source.gate = own;
  if (!section.has("modeling")) return;
  places.of[place + ".modeling"] = section.place("modeling");
  if (!section.node("modeling").IsMap()) return section.read("modeling", source.model);
  const YamlSection modeling = *section.section("modeling", {"name", "loss", "options"});
  modeling.read("name", source.model);
  read_loss(modeling, place, source, places);
  read_options(modeling, "options", place + ".options.", source.options, places);
}

/// Reads the settings of single sources. What the only odometry states is stated for the drive.
void read_sources(const YamlSection& top, FusionSettings& settings, Places& places) {
  const std::vector<SourceEntry> entries = source_entries(top);
  const auto odometries = std::count_if(entries.begin(), entries.end(),
                                        [](const SourceEntry& entry) { return entry.kind == kOdometryKind; });
  for (const SourceEntry& entry : entries) {
    SourceSettings source;
    const bool is_only = entry.kind == kOdometryKind && odometries == 1;
    const std::string place = is_only ? std::string(kOdometryKind) : "sources." + entry.name;
    if (entry.kind == kOdometryKind) {
      read_relative(entry.section, place, source, places);
    } else if (entry.kind == kGnssKind) {
      read_absolute(entry.section, place, settings.gate, source, places);
    } else {
      read_loss(entry.section, place, source, places);
    }
    if (is_only) {
      if (!source.model.empty()) settings.odometry_model = source.model;
      settings.odometry_options = source.options;
      source = {.calibration = source.calibration, .loss = source.loss};
    }
    if (!(source == SourceSettings{})) settings.sources[entry.name] = std::move(source);
  }
}

}  // namespace

void read_settings(const YamlSection& top, FusionSettings& settings, Places& places) {
  (void)read_gate(top, settings.gate);
  read_sources(top, settings, places);
  if (const auto start = top.read_word("initial_guess", kInitialGuesses))
    settings.initial_guess.method = *start == 0 ? StartMethod::anchored : StartMethod::dead_reckoning;
  read_modeling(top, settings, places);
  read_calibration(top, settings, places);
  if (const auto noise = top.read_word("noise", kNoises)) settings.estimates_noise = *noise == 0;
}

}  // namespace waymark::drive
