#include <charconv>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/folder_lock.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/program/commands/commands.hpp>
#include <waymark/tools/program/jobs/inspection/drive_statistics.hpp>
#include <waymark/tools/program/terminal/output.hpp>
#include <waymark/tools/simulation/simulation.hpp>
#include <waymark/tools/simulation/source_statistics.hpp>
#include <waymark/tools/text/number_text.hpp>
#include <waymark/tools/text/table.hpp>

namespace waymark::program {
namespace {

struct SimulateOptions {
  CommonOptions common;
  bool list = false;
  std::string preset;
  std::optional<std::uint64_t> seed;
  std::optional<double> duration_s;
  std::string folder;
};

ExitCode list_presets(const Console& console) {
  text::Table table{.columns = {"preset", "seed", "duration [s]", "description"}};
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const simulation::SimulationPreset& preset : simulation::simulation_presets()) {
    table.rows.push_back({preset.name, std::to_string(preset.default_seed),
                          fmt::format("{:g}", preset.recipe.duration_s), preset.description});
    json.push_back({{"name", preset.name},
                    {"default_seed", preset.default_seed},
                    {"duration_s", preset.recipe.duration_s},
                    {"description", preset.description}});
  }
  console.result(console.json() ? json_document("presets", {{"presets", json}})
                                : text::table_text(table, console.look()));
  return kSuccess;
}

/// Logs of a real drive must not be overwritten as if they were an old simulation.
/// @throws UsageError
void require_no_real_drive(const std::string& folder, const simulation::SimulationRecipe& recipe) {
  std::vector<std::string> files = {"drive.yaml", "truth.csv"};
  for (const simulation::OdometryRecipe& odometry : recipe.all_odometry())
    files.push_back(odometry.name + ".csv");
  for (const std::string& name : files) {
    const std::string path = folder + "/" + name;
    std::error_code unknown;
    if (!std::filesystem::exists(path, unknown)) continue;
    std::string first_line;
    std::getline(std::ifstream(path), first_line);
    if (first_line.find("no vehicle drove this") == std::string::npos)
      throw UsageError(path + ": exists and was not written by simulate; choose another folder");
  }
}

void print_sources(const simulation::SimulatedDrive& drive, const Console& console) {
  text::Table table{.title = drive.name,
                    .columns = {"source", "kind", "rate [Hz]", "readings", "available [%]", "rms [m]"}};
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const simulation::SourceStatistics& source : simulation::source_statistics(drive)) {
    table.rows.push_back({source.name, source.kind, fmt::format("{:g}", source.rate_hz),
                          std::to_string(source.readings), text::decimals(source.availability_percent, 2),
                          text::decimals(source.rms_m, 3)});
    json.push_back({{"name", source.name},
                    {"kind", source.kind},
                    {"rate_hz", source.rate_hz},
                    {"readings", source.readings},
                    {"availability_percent", source.availability_percent},
                    {"rms_m", source.rms_m}});
  }
  console.result(console.json() ? json_document("sources", {{"name", drive.name},
                                                            {"duration_s", drive.recipe.duration_s},
                                                            {"distance_m", drive.distance_m},
                                                            {"sources", json}})
                                : text::table_text(table, console.look()));
}

ExitCode simulate_drive(const SimulateOptions& options) {
  const Console console(options.common);
  if (options.list) return list_presets(console);
  if (options.preset.empty()) throw UsageError("--preset is required (--list shows all)");
  const simulation::SimulationPreset& preset = simulation::simulation_preset(options.preset);
  if (options.folder.empty()) throw UsageError("--out is required: the folder for the logs");
  simulation::SimulationRecipe recipe = preset.recipe;
  if (options.duration_s) recipe = simulation::with_duration(recipe, *options.duration_s);
  simulation::check(recipe);
  require_no_real_drive(options.folder, recipe);
  formats::make_folder(options.folder);
  const formats::FolderLock lock(options.folder);
  console.progress("simulating " + preset.name);
  const simulation::SimulatedDrive drive =
      simulation::simulate(recipe, options.seed.value_or(preset.default_seed));
  stop_if_interrupted();
  simulation::write_simulated_drive(drive, options.folder);
  if (drive.recipe.has_several()) {
    console.end_progress();
    print_sources(drive, console);
  } else {
    print_drive_statistics(options.folder + "/drive.yaml", options.common, console);
  }
  return kSuccess;
}

/// The parser would turn -1, and numbers beyond 64 bits, into the largest one.
std::string wrong_seed(const std::string& text) {
  std::uint64_t seed = 0;
  const char* end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, seed);
  if (error == std::errc() && stopped == end) return {};
  return "must be a whole number from 0 to 2^64 - 1, got " + text;
}

}  // namespace

void add_simulate(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "simulate",
      "Write raw logs of a simulated drive, with truth and drive.yaml\n\n"
      "The errors of the logs are like those of real receivers and wheels, biases and gaps "
      "included. The same seed gives the same logs. Statistics of the drive are printed, as by "
      "'waymark inspect DRIVE.yaml'. For a drive with several odometries or receivers, the "
      "availability and the error of each are printed.");
  const auto options = std::make_shared<SimulateOptions>();
  auto* list = command->add_flag("--list", options->list, "List the presets");
  auto* preset = command->add_option("--preset", options->preset, "Drive to simulate")->type_name("PRESET");
  command->add_option("--seed", options->seed, "Seed of all random numbers; default: the preset's")
      ->check(CLI::Validator(wrong_seed, ""))
      ->needs(preset);
  command->add_option("--duration", options->duration_s, "Seconds, instead of the preset's")
      ->type_name("SECONDS")
      ->needs(preset);
  command
      ->add_option("-o,--out", options->folder,
                   "Folder for odometry.csv, gnss.json (or a log per source), truth.csv, drive.yaml")
      ->type_name("DIR")
      ->needs(preset);
  list->excludes(preset);
  add_common_options(*command, options->common);
  command->footer(
      "Example:\n  waymark simulate --preset urban --seed 7 -o simulated && waymark run simulated/drive.yaml "
      "-o out");
  command->callback([options, &action] { action = [options] { return simulate_drive(*options); }; });
}

}  // namespace waymark::program
