#include <waymark/tools/drive/description/settings_yaml.hpp>

#include <array>
#include <limits>

#include <fmt/format.h>

#include <waymark/core/base/angle.hpp>
#include <waymark/core/base/error.hpp>

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
    free->read(option, options[option]);
    places.of[name + option] = free->place(option);
  }
}

void read_odometry_model(const YamlSection& top, FusionSettings& settings, Places& places) {
  const YamlSection section = *top.free_section("odometry");
  section.read("model", settings.odometry_model);
  if (section.has("model")) places.of["odometry.model"] = section.place("model");
  read_options(section, "options", "odometry.options.", settings.odometry_options, places);
}

void read_gate(const YamlSection& top, GateOptions& options) {
  const auto gate = top.section(
      "gate", {"enabled", "max_angle_deg", "max_displacement_m", "chord_s", "max_chord_s", "min_chord_m"});
  if (!gate) return;
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

}  // namespace

void read_settings(const YamlSection& top, FusionSettings& settings, Places& places) {
  read_odometry_model(top, settings, places);
  read_gate(top, settings.gate);
  if (const auto start = top.read_word("initial_guess", kInitialGuesses))
    settings.initial_guess.method = *start == 0 ? StartMethod::anchored : StartMethod::dead_reckoning;
  read_modeling(top, settings, places);
  read_calibration(top, settings, places);
  if (const auto noise = top.read_word("noise", kNoises)) settings.estimates_noise = *noise == 0;
}

}  // namespace waymark::drive
