#include <waymark/tools/drive/model/provenance.hpp>

#include <numbers>

#include <fmt/format.h>

namespace waymark::drive {
namespace {

using Provenance = std::vector<std::pair<std::string, std::string>>;

std::string file_name(const std::string& path) {
  return path.substr(path.find_last_of('/') + 1);
}

std::string in_words(const GateOptions& gate) {
  if (!*gate.enabled) return "off";
  return fmt::format("angle {:.6g} deg displacement {:.6g} m", gate.max_angle_rad * 180 / std::numbers::pi,
                     gate.max_displacement_m);
}

void add_settings(const FusionSettings& settings, const NoiseEstimate& noise, Provenance& provenance) {
  provenance.emplace_back("modeling", settings.modeling);
  for (const auto& [name, value] : settings.modeling_options)
    provenance.emplace_back("modeling_option", name + "=" + value);
  if (!settings.loss.empty() && settings.loss != "none") provenance.emplace_back("loss", settings.loss);
  for (const NoiseParameter& parameter : noise.parameters)
    provenance.emplace_back(
        "noise", parameter.owner + " " + parameter.name() + "=" + shortest(parameter.value) + " estimated");
  for (const auto& [name, value] : *settings.calibration)
    provenance.emplace_back("calibration", name + "=" + value);
}

}  // namespace

std::string corrupt_warning(const PrepareReport& report) {
  const std::size_t corrupt =
      report.odometry.corrupt + report.gnss.corrupt + report.truth.corrupt + report.sensor.corrupt;
  return corrupt == 0 ? "" : fmt::format("{} corrupt records were left out", corrupt);
}

Provenance provenance_of(const PreparedDrive& drive, const ModeledDrive& modeled,
                         const TypeRegistry& registry) {
  const FusionSettings& settings = modeled.settings;
  Provenance provenance{{"drive", drive.name}};
  if (!drive.environment.empty()) provenance.emplace_back("environment", drive.environment);
  for (const InputFile& input : drive.inputs)
    provenance.emplace_back("input", file_name(input.path) + " " + input.fingerprint);
  add_settings(settings, modeled.noise, provenance);
  if (registry.gnss_modeling(settings.modeling).complete)
    provenance.emplace_back(std::string(kFixErrors), "correlated");
  for (const PreparedSensor& sensor : drive.sensors) provenance.emplace_back("sensor", sensor.name);
  for (const PluginRecord& plugin : registry.plugins()) {
    if (plugin.place != "built in") provenance.emplace_back("plugin", plugin.name + " " + plugin.version);
  }
  provenance.emplace_back("gate", in_words(settings.gate));
  provenance.emplace_back(
      "start", settings.initial_guess.method == StartMethod::anchored ? "anchored" : "dead_reckoning");
  for (const std::string& note : drive.report.notes) provenance.emplace_back("assumed", note);
  for (const std::string& note : modeled.notes) provenance.emplace_back("assumed", note);
  if (const std::string corrupt = corrupt_warning(drive.report); !corrupt.empty())
    provenance.emplace_back("warning", corrupt);
  for (const std::string& warning : modeled.warnings()) provenance.emplace_back("warning", warning);
  return provenance;
}

}  // namespace waymark::drive
