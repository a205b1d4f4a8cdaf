#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include <waymark/core/error.hpp>
#include <waymark/formats/text_file.hpp>
#include <waymark/tools/program/commands.hpp>
#include <waymark/tools/program/covariance.hpp>
#include <waymark/tools/program/output.hpp>
#include <waymark/tools/program/pipeline.hpp>
#include <waymark/tools/program/program_registry.hpp>
#include <waymark/tools/reproduction/reproduction_report.hpp>
#include <waymark/tools/simulation/simulation.hpp>

namespace waymark {
namespace {

struct ReproduceOptions {
  CommonOptions common;
  std::string folder;
  std::vector<std::string> files;  ///< drive.yaml
  std::vector<int> presets;        ///< the paper's datasets; empty: all
  std::optional<std::uint64_t> seed;
};

/// A drive to be studied.
struct Subject {
  std::string path;  ///< of its drive.yaml
  int dataset = 0;   ///< of the paper; 0: none
};

std::vector<Setting> joined_settings(std::initializer_list<std::vector<Setting>> lists) {
  std::vector<Setting> all;
  for (const std::vector<Setting>& list : lists) all.insert(all.end(), list.begin(), list.end());
  return all;
}

/// Covariances only of a minimum: elsewhere they mean nothing.
Evaluation evaluate_fused(GraphDocument& document, const std::vector<TruthPose>& truth, bool converged) {
  if (converged) {
    try {
      add_covariances(document, "fixes");
    } catch (const InputError&) {
      document.covariances.clear();  // H is singular where the rule of g2o ended the run
    }
  }
  return evaluate_document(document, truth);
}

/// How fixes are kept out of a drive without truth.
struct Way {
  std::string name;
  int withhold_every = 0;
  OutagePattern outage;
};
const Way kWays[] = {{"every 10th fix", 10, {}},
                     {"outages of 30 s every 240 s", 0, {30, 240}},
                     {"outages of 60 s every 240 s", 0, {60, 240}}};

DriveResult study(const Subject& subject, const TypeRegistry& registry, const Console& console) {
  DriveConfig config = load_drive_config(subject.path);
  config.withhold_every = 0;
  config.outage = {};
  console.progress(config.name + ": reading logs");
  const DriveLogs logs =
      read_drive_logs(config, [&](std::string_view name) { return registry.find_log_reader(name); });
  std::string step;
  const Laboratory laboratory{registry, evaluate_fused,
                              [&](const std::string& setting) {
                                stop_if_interrupted();
                                console.progress(config.name + ": " + step + setting);
                              },
                              &interrupted};
  StudiedDrive drive(config, logs);
  DriveResult result = study_drive(subject.dataset, drive,
                                   joined_settings({paper_settings(), our_settings(), cause_settings(),
                                                    minimum_settings(), convergence_settings()}),
                                   laboratory);
  stop_if_interrupted();
  if (!drive.drive().truth.empty()) return result;
  for (const Way& way : kWays) {
    DriveConfig with_gaps = config;
    with_gaps.withhold_every = way.withhold_every;
    with_gaps.outage = way.outage;
    StudiedDrive gapped(with_gaps, logs);
    step = way.name + ", ";
    result.withheld.push_back(
        {way.name,
         run_settings(gapped, joined_settings({paper_settings(), our_settings(), minimum_settings()}),
                      laboratory)});
  }
  stop_if_interrupted();
  return result;
}

std::vector<std::string> write_report(const ReproductionReport& report, const std::string& json,
                                      const std::string& folder) {
  std::vector<std::string> files;
  const auto write = [&](const std::string& name, const std::string& content) {
    write_file_atomically(folder + "/" + name, content);
    files.push_back(folder + "/" + name);
  };
  write("REPRODUCTION.md", report_markdown(report));
  write("reproduction.json", json);
  for (const ReportTable& table : report.tables) write(table.file + ".csv", table_csv(table));
  write(report.runs.file + ".csv", table_csv(report.runs));
  return files;
}

/// Drives that were given: a wrong file at the end of the list is found before the work.
std::vector<Subject> given_subjects(const ReproduceOptions& options) {
  if (!options.presets.empty() || options.seed)
    throw UsageError("--drives and --seed are for the simulated drives; drive.yaml files are given");
  std::vector<Subject> subjects;
  for (const std::string& path : options.files) {
    (void)load_drive_config(path);
    subjects.push_back({path, 0});
  }
  return subjects;
}

/// @throws UsageError for a number that is none of the paper's
std::vector<int> chosen_datasets(const ReproduceOptions& options) {
  std::vector<int> datasets;
  for (const PaperDrive& drive : paper_drives()) {
    const bool chosen =
        std::find(options.presets.begin(), options.presets.end(), drive.dataset) != options.presets.end();
    if (chosen || options.presets.empty()) datasets.push_back(drive.dataset);
  }
  for (const int asked : options.presets) {
    if (std::find(datasets.begin(), datasets.end(), asked) == datasets.end())
      throw UsageError(
          fmt::format("--drives: the paper's drives are 1 to {}, got {}", paper_drives().size(), asked));
  }
  return datasets;
}

/// The paper's drives, simulated and written as raw logs: they come in by the door of real ones.
std::vector<Subject> simulated_subjects(const ReproduceOptions& options, const Console& console) {
  std::vector<Subject> subjects;
  for (const int dataset : chosen_datasets(options)) {
    stop_if_interrupted();
    const SimulationPreset& preset = simulation_preset(fmt::format("paper-{}", dataset));
    console.progress("simulating " + preset.name);
    const std::string folder = options.folder + "/drives/" + preset.name;
    make_folder(folder);
    write_simulated_drive(simulate(preset.recipe, options.seed.value_or(preset.default_seed)), folder);
    subjects.push_back({folder + "/drive.yaml", dataset});
  }
  return subjects;
}

std::string introduction(const ReproduceOptions& options) {
  std::string text = "waymark " WAYMARK_VERSION
                     ". Das and Dubbelman, An Experimental Study on Relative and Absolute Pose Graph "
                     "Fusion for Vehicle Localization. ";
  if (!options.files.empty())
    return text + "Its experiment on other drives, " + fmt::format("{} of them.", options.files.size());
  return text + "Its eight drives are not public: those shown beside its figures are SIMULATED (" +
         (options.seed ? fmt::format("seed {}", *options.seed) : "the presets' seeds") +
         ") so that length, rates, and the errors of the raw fixes are like its tables'.";
}

ExitCode reproduce(const ReproduceOptions& options) {
  const Console console(options.common);
  const TypeRegistry registry = make_registry(options.common);
  const bool given = !options.files.empty();
  std::vector<Subject> subjects;
  if (given) subjects = given_subjects(options);
  (void)chosen_datasets(options);
  make_folder(options.folder);
  if (!given) subjects = simulated_subjects(options, console);
  std::vector<DriveResult> results;
  for (const Subject& subject : subjects) results.push_back(study(subject, registry, console));
  console.end_progress();
  const ReproductionReport report = make_report(results, introduction(options));
  const std::string json = report_json(report, results);
  const std::vector<std::string> files = write_report(report, json, options.folder);
  if (options.common.json) {
    console.result(json);
    return kSuccess;
  }
  std::string text = report_text(report) + "\nwritten:\n";
  for (const std::string& file : files) text += "  " + file + "\n";
  console.result(text);
  return kSuccess;
}

}  // namespace

void add_reproduce(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("reproduce", "The paper's experiment: its tables beside ours");
  const auto options = std::make_shared<ReproduceOptions>();
  command->add_option(
      "drives", options->files,
      "drive.yaml files to run the experiment on; without: the paper's eight drives, simulated");
  command->add_option("-o,--out", options->folder, "Folder for tables and report")
      ->required()
      ->type_name("DIR");
  command->add_option("--drives", options->presets, "Which of the paper's drives to simulate; default: all")
      ->delimiter(',')
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("N[,N]");
  command->add_option("--seed", options->seed, "Seed of the simulated drives; default: each preset's own");
  add_common_options(*command, options->common);
  command->footer("Example:\n  waymark reproduce --out results");
  command->callback([options, &action] { action = [options] { return reproduce(*options); }; });
}

}  // namespace waymark
