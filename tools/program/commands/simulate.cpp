#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/drive/description/drive_file.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>
#include <waymark/tools/program/commands/commands.hpp>
#include <waymark/tools/program/jobs/program_registry.hpp>
#include <waymark/tools/program/terminal/output.hpp>
#include <waymark/tools/simulation/simulation.hpp>
#include <waymark/tools/simulation/statistics.hpp>
#include <waymark/tools/text/text_table.hpp>

namespace waymark::program {
namespace {

struct SimulateOptions {
  CommonOptions common;
  bool list = false;
  std::string preset;
  std::string describe;
  std::optional<std::uint64_t> seed;
  std::optional<double> duration_s;
  std::string folder;
};

ExitCode list_presets(const Console& console) {
  text::TextTable table({"preset", "seed", "duration [s]", "description"});
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const simulation::SimulationPreset& preset : simulation::simulation_presets()) {
    table.add({preset.name, std::to_string(preset.default_seed),
               fmt::format("{:g}", preset.recipe.duration_s), preset.description});
    json.push_back({{"name", preset.name},
                    {"default_seed", preset.default_seed},
                    {"duration_s", preset.recipe.duration_s},
                    {"description", preset.description}});
  }
  console.result(console.json() ? json_document("presets", {{"presets", json}}) : table.text(console.look()));
  return kSuccess;
}

/// NaN: not defined, or there is no truth to define it.
std::string number(double value, int decimals) {
  return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value, decimals);
}

std::string statistics_text(const std::string& name, const simulation::DriveStatistics& s) {
  std::string text = name + "\n";
  const auto line = [&text](const std::string& label, const std::string& value) {
    text += fmt::format("  {:<34} {}\n", label, value);
  };
  line("duration", number(s.duration_s, 2) + " s");
  line("distance", number(s.distance_m / 1000, 3) + " km");
  line("odometry points", std::to_string(s.odometry_points));
  line("fixes", fmt::format("{}, {} epochs missing", s.fixes, s.missing_epochs));
  line("raw fixes Max / Acc / Prec", number(s.gnss.max_m, 3) + " / " + number(s.gnss.accuracy_m, 3) + " / " +
                                         number(s.gnss.precision_m, 3) + " m");
  line("rejected by the gate", fmt::format("{} ({:.2f} %)", s.rejected, s.rejected_percent));
  for (std::size_t i = 0; i < s.autocorrelation.size(); ++i)
    line(fmt::format("autocorrelation of the error, {} s", evaluation::kAutocorrelationLags[i]),
         number(s.autocorrelation[i], 3));
  line("odometry drift over 1 km", number(s.drift_percent, 3) + " %");
  line("yaw drift", number(s.yaw_drift_deg_per_minute, 3) + " deg/min");
  return text;
}

nlohmann::ordered_json statistics_json(const std::string& name, const simulation::DriveStatistics& s) {
  nlohmann::ordered_json json = {{"name", name},
                                 {"duration_s", s.duration_s},
                                 {"distance_m", s.distance_m},
                                 {"odometry_points", s.odometry_points},
                                 {"fixes", s.fixes},
                                 {"missing_epochs", s.missing_epochs},
                                 {"gnss_max_m", s.gnss.max_m},
                                 {"gnss_accuracy_m", s.gnss.accuracy_m},
                                 {"gnss_precision_m", s.gnss.precision_m},
                                 {"rejected", s.rejected},
                                 {"rejected_percent", s.rejected_percent}};
  for (std::size_t i = 0; i < s.autocorrelation.size(); ++i)
    json[fmt::format("autocorrelation_{}s", evaluation::kAutocorrelationLags[i])] = s.autocorrelation[i];
  json["drift_percent"] = s.drift_percent;
  json["yaw_drift_deg_per_minute"] = s.yaw_drift_deg_per_minute;
  return json;
}

/// A drive through the door by which every drive comes, simulated ones too.
ExitCode describe(const std::string& path, const CommonOptions& common, const Console& console) {
  const drive::DriveFile file = drive::load_drive_file(path);
  const TypeRegistry registry = make_registry(common, file.description.plugins);
  const drive::PreparedDrive drive = drive::load_drive(file.description, registry, watch_reading(console));
  console.end_progress();
  const simulation::DriveStatistics statistics = simulation::drive_statistics(drive, file.settings.gate);
  console.result(console.json() ? json_document("simulate", statistics_json(drive.name, statistics))
                                : statistics_text(drive.name, statistics));
  return kSuccess;
}

/// Logs of a real drive must not be taken for an old simulation. @throws UsageError
void require_no_real_drive(const std::string& folder) {
  for (const char* name : {"drive.yaml", "odometry.csv", "truth.csv"}) {
    const std::string path = folder + "/" + name;
    if (!std::filesystem::exists(path)) continue;
    std::string first_line;
    std::getline(std::ifstream(path), first_line);
    if (first_line.find("no vehicle drove this") == std::string::npos)
      throw UsageError(path + ": is there and was not made by simulate; choose another folder");
  }
}

ExitCode simulate_drive(const SimulateOptions& options) {
  const Console console(options.common);
  if (options.list) return list_presets(console);
  if (!options.describe.empty()) return describe(options.describe, options.common, console);
  if (options.preset.empty()) throw UsageError("--preset is required (or --list, to see which there are)");
  const simulation::SimulationPreset& preset = simulation::simulation_preset(options.preset);
  if (options.folder.empty()) throw UsageError("--out is required: the folder for the logs");
  simulation::SimulationRecipe recipe = preset.recipe;
  if (options.duration_s) recipe = simulation::with_duration(recipe, *options.duration_s);
  simulation::check(recipe);
  require_no_real_drive(options.folder);
  formats::make_folder(options.folder);
  console.progress("simulating " + preset.name);
  const simulation::SimulatedDrive drive =
      simulation::simulate(recipe, options.seed.value_or(preset.default_seed));
  stop_if_interrupted();
  simulation::write_simulated_drive(drive, options.folder);
  return describe(options.folder + "/drive.yaml", options.common, console);
}

/// The parser would take -1 and numbers beyond 64 bits for the largest one.
std::string wrong_seed(const std::string& text) {
  std::uint64_t seed = 0;
  const char* end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, seed);
  if (error == std::errc() && stopped == end) return {};
  return "must be a whole number from 0 to 2^64 - 1, got " + text;
}

}  // namespace

void add_simulate(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("simulate",
                                     "Raw logs of a simulated drive, with truth and drive.yaml\n\n"
                                     "The errors of the logs are like those of real receivers and wheels, "
                                     "biases and gaps included. The same "
                                     "seed gives the same logs. What the drive is like is printed.");
  const auto options = std::make_shared<SimulateOptions>();
  auto* list = command->add_flag("--list", options->list, "The presets");
  auto* preset =
      command->add_option("--preset", options->preset, "Which drive to simulate")->type_name("PRESET");
  command->add_option("--seed", options->seed, "Seed of all random numbers; default: the preset's")
      ->check(CLI::Validator(wrong_seed, ""))
      ->needs(preset);
  command->add_option("--duration", options->duration_s, "Seconds, instead of the preset's")
      ->type_name("SECONDS")
      ->needs(preset);
  command
      ->add_option("-o,--out", options->folder, "Folder for odometry.csv, gnss.json, truth.csv, drive.yaml")
      ->type_name("DIR")
      ->needs(preset);
  command
      ->add_option("--describe", options->describe,
                   "Instead of simulating: the same table of any drive.yaml, to compare with")
      ->type_name("DRIVE.yaml")
      ->excludes(list)
      ->excludes(preset);
  list->excludes(preset);
  add_common_options(*command, options->common);
  command->footer(
      "Example:\n  waymark simulate --preset urban --seed 7 -o simulated && waymark run simulated/drive.yaml "
      "-o out");
  command->callback([options, &action] { action = [options] { return simulate_drive(*options); }; });
}

}  // namespace waymark::program
