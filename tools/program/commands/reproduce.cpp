#include <algorithm>
#include <cctype>
#include <optional>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/folder_lock.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/drive/description/drive_file.hpp>
#include <waymark/tools/drive/model/minimize.hpp>
#include <waymark/tools/program/commands/commands.hpp>
#include <waymark/tools/program/jobs/evaluation/document_evaluation.hpp>
#include <waymark/tools/program/jobs/program_registry.hpp>
#include <waymark/tools/program/terminal/output.hpp>
#include <waymark/tools/reproduction/experiment/consistency_study.hpp>
#include <waymark/tools/reproduction/experiment/experiment.hpp>
#include <waymark/tools/reproduction/page/reproduction_page.hpp>
#include <waymark/tools/simulation/simulation.hpp>
#include <waymark/version.hpp>

namespace waymark::program {
namespace {

struct ReproduceOptions {
  CommonOptions common;
  std::string folder;
  std::vector<std::string> files;  ///< drive.yaml
  std::vector<int> presets;        ///< datasets of the paper; empty: all
  std::optional<std::uint64_t> seed;
  bool ablation = false;
  std::optional<int> consistency;  ///< number of drives to draw
};

/// A drive of the study.
struct Subject {
  drive::DriveDescription drive;
  int dataset = 0;      ///< of the paper; 0: none
  std::string group{};  ///< the preset of which it is a draw, if draws are pooled
};

/// Returns the drive of a drive.yaml without its further sensors: the settings define the rest, the
/// same for every drive.
drive::DriveDescription read_drive(const std::string& path) {
  drive::DriveDescription description = drive::load_drive_file(path).description;
  description.sensors.clear();
  return description;
}

/// Covariances are computed only at a minimum, because elsewhere they mean nothing.
evaluation::Evaluation evaluate_fused(drive::ModeledDrive& fused, const std::vector<TruthPose>& truth,
                                      bool converged) {
  if (converged) {
    try {
      drive::add_covariances(fused, "fixes");
    } catch (const InputError&) {
      fused.document.covariances.clear();  // H is singular at the place where g2o's rule ended the run
    }
  }
  return evaluate_document(fused.document, truth);
}

/// Progress of all runs of all drives.
class StudyProgress {
 public:
  StudyProgress(const reproduction::Experiment& experiment, const std::vector<Subject>& subjects,
                const Console& console)
      : drives_(subjects.size()), steps_(console, runs_of(experiment, subjects)), experiment_(experiment) {}

  void begin_drive(const drive::DriveDescription& drive) {
    ++drive_;
    run_ = 0;
    runs_ = reproduction::run_count(experiment_, drive.truth.has_value());
  }
  void begin_run(const std::string& setting) {
    steps_.next(fmt::format("{}: drive {} of {}  setting {} of {}", setting, drive_, drives_, ++run_, runs_));
  }

 private:
  static std::size_t runs_of(const reproduction::Experiment& experiment,
                             const std::vector<Subject>& subjects) {
    std::size_t runs = 0;
    for (const Subject& subject : subjects)
      runs += reproduction::run_count(experiment, subject.drive.truth.has_value());
    return runs;
  }

  std::size_t drives_;
  StepProgress steps_;
  const reproduction::Experiment& experiment_;
  std::size_t drive_ = 0;  ///< 1, 2, ...
  std::size_t run_ = 0;    ///< of the drive
  std::size_t runs_ = 0;   ///< of the drive
};

reproduction::DriveResult study(const reproduction::Experiment& experiment, const Subject& subject,
                                const TypeRegistry& registry, const Console& console,
                                StudyProgress& progress) {
  progress.begin_drive(subject.drive);
  const drive::DriveLogs logs = drive::read_drive_logs(subject.drive, registry, watch_reading(console));
  const reproduction::Laboratory laboratory{registry, evaluate_fused,
                                            [&](const std::string& setting) {
                                              stop_if_interrupted();
                                              progress.begin_run(setting);
                                            },
                                            &interrupted};
  reproduction::DriveResult result =
      reproduction::run_experiment(experiment, subject.dataset, subject.drive, logs, laboratory);
  result.group = subject.group;
  stop_if_interrupted();
  return result;
}

std::vector<std::string> write_report(const reproduction::ReproductionReport& report, const std::string& json,
                                      const std::string& folder) {
  std::vector<std::string> files;
  const auto write = [&](const std::string& name, const std::string& content) {
    formats::write_file_atomically(folder + "/" + name, content);
    files.push_back(folder + "/" + name);
  };
  std::string capitals = report.name;
  for (char& c : capitals) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  write(capitals + ".md", reproduction::report_markdown(report));
  write(report.name + ".json", json);
  for (const text::Table& table : report.tables) write(table.file + ".csv", text::table_csv(table));
  write(report.runs.file + ".csv", text::table_csv(report.runs));
  return files;
}

/// Returns the given drives. A wrong file at the end of the list is found before the work.
std::vector<Subject> given_subjects(const ReproduceOptions& options) {
  if (!options.presets.empty() || options.seed)
    throw UsageError("--drives and --seed are for the simulated drives; drive.yaml files are given");
  std::vector<Subject> subjects;
  for (const std::string& path : options.files) {
    subjects.push_back({read_drive(path), 0});
  }
  return subjects;
}

/// @throws UsageError for a number that is not in the paper
std::vector<int> chosen_datasets(const ReproduceOptions& options) {
  std::vector<int> datasets;
  for (const reproduction::PaperDrive& drive : reproduction::paper_drives()) {
    const bool chosen =
        std::find(options.presets.begin(), options.presets.end(), drive.dataset) != options.presets.end();
    if (chosen || options.presets.empty()) datasets.push_back(drive.dataset);
  }
  for (const int asked : options.presets) {
    if (std::find(datasets.begin(), datasets.end(), asked) == datasets.end())
      throw UsageError(fmt::format("--drives: the paper's drives are 1 to {}, got {}",
                                   reproduction::paper_drives().size(), asked));
  }
  return datasets;
}

/// Writes a drive as raw logs, so that simulated drives are read like real ones.
drive::DriveDescription write_simulated(const simulation::SimulationPreset& preset, std::uint64_t seed,
                                        const std::string& folder, StepProgress& progress) {
  stop_if_interrupted();
  progress.next("simulating " + preset.name);
  formats::make_folder(folder);
  simulation::write_simulated_drive(simulation::simulate(preset.recipe, seed), folder);
  return read_drive(folder + "/drive.yaml");
}

/// Returns the drives of the paper.
std::vector<Subject> simulated_subjects(const ReproduceOptions& options, const Console& console) {
  std::vector<Subject> subjects;
  const std::vector<int> datasets = chosen_datasets(options);
  StepProgress progress(console, datasets.size());
  for (const int dataset : datasets) {
    const simulation::SimulationPreset& preset =
        simulation::simulation_preset(fmt::format("paper-{}", dataset));
    subjects.push_back({write_simulated(preset, options.seed.value_or(preset.default_seed),
                                        options.folder + "/drives/" + preset.name, progress),
                        dataset});
  }
  return subjects;
}

/// Returns the drives of the consistency study.
std::vector<Subject> drawn_subjects(const ReproduceOptions& options, const Console& console) {
  std::vector<Subject> subjects;
  std::vector<std::string> presets;
  for (const simulation::SimulationPreset& preset : simulation::simulation_presets())
    presets.push_back(preset.name);
  const std::vector<reproduction::Draw> draws =
      reproduction::consistency_draws(presets, *options.consistency);
  StepProgress progress(console, draws.size());
  for (const reproduction::Draw& draw : draws) {
    const std::string folder = fmt::format("{}/drives/{}-{}", options.folder, draw.preset, draw.seed);
    subjects.push_back(
        {write_simulated(simulation::simulation_preset(draw.preset), draw.seed, folder, progress), 0,
         draw.preset});
  }
  return subjects;
}

reproduction::Experiment chosen_experiment(const ReproduceOptions& options) {
  if (options.ablation) return reproduction::ablation_experiment();
  return options.consistency ? reproduction::consistency_experiment() : reproduction::paper_experiment();
}

/// Returns the simulated drives, or the given ones. Errors in the request are found
/// before the work.
std::vector<Subject> find_subjects(const ReproduceOptions& options, const Console& console) {
  std::vector<Subject> given;
  if (!options.files.empty()) given = given_subjects(options);
  (void)chosen_datasets(options);
  formats::make_folder(options.folder);
  if (!given.empty()) return given;
  return options.consistency ? drawn_subjects(options, console) : simulated_subjects(options, console);
}

std::string whose_drives(const ReproduceOptions& options) {
  if (!options.files.empty()) return fmt::format("Drives given: {}.", options.files.size());
  return "The paper's eight drives are not public. These drives are SIMULATED (" +
         (options.seed ? fmt::format("seed {}", *options.seed) : "the presets' seeds") +
         "); their lengths, rates and errors of the raw fixes are like those in the paper's tables.";
}

std::string introduction(const ReproduceOptions& options) {
  const std::string program = "waymark " WAYMARK_VERSION ". ";
  if (options.consistency)
    return program +
           fmt::format("{} SIMULATED drives: seeds {} to {}, none left out, presets in turn.",
                       *options.consistency, reproduction::kFirstStudySeed,
                       reproduction::kFirstStudySeed + static_cast<std::uint64_t>(*options.consistency) - 1);
  const std::string paper =
      "Das and Dubbelman, An Experimental Study on Relative and Absolute Pose Graph Fusion for Vehicle "
      "Localization";
  if (options.ablation)
    return program + "The default model with one part changed at a time, and common alternatives. " +
           (options.files.empty() ? "Drives: like those of " + paper + ". " : "") + whose_drives(options);
  return program + paper + ". " + (options.files.empty() ? "" : "Its experiment on other drives. ") +
         whose_drives(options);
}

ExitCode reproduce(const ReproduceOptions& options) {
  if (options.consistency && (!options.files.empty() || !options.presets.empty() || options.seed))
    throw UsageError("--consistency simulates its own drives; leave out drive.yaml, --drives and --seed");
  const Console console(options.common);
  const TypeRegistry registry = make_registry(options.common);
  const reproduction::Experiment experiment = chosen_experiment(options);
  const std::vector<Subject> subjects = find_subjects(options, console);
  const formats::FolderLock lock(options.folder);
  StudyProgress progress(experiment, subjects, console);
  std::vector<reproduction::DriveResult> results;
  for (const Subject& subject : subjects)
    results.push_back(study(experiment, subject, registry, console, progress));
  console.end_progress();
  const reproduction::ReproductionReport report = experiment.report(results, introduction(options));
  const std::string json = reproduction::report_json(report, results);
  std::vector<std::string> files = write_report(report, json, options.folder);
  const drawing::Page page = reproduction::reproduction_page(report, results, WAYMARK_VERSION);
  files.push_back(drawing::write_page(page, options.folder, report.name).front());
  if (options.common.json) {
    console.result(json);
    return kSuccess;
  }
  std::string text = reproduction::report_text(report, console.look()) + "\nwritten:\n";
  for (const std::string& file : files) text += "  " + file + "\n";
  text += fmt::format("  {} figures as SVG and CSV in {}/figures\n", drawing::figures_of(page).size(),
                      options.folder);
  console.result(text);
  return kSuccess;
}

}  // namespace

void add_reproduce(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "reproduce",
      "Repeat the paper's experiment: its tables beside ours\n\n"
      "The paper is Das and Dubbelman, An Experimental Study on Relative and Absolute Pose Graph "
      "Fusion for Vehicle Localization. The report shows the results of its settings and which of "
      "its findings hold.");
  const auto options = std::make_shared<ReproduceOptions>();
  command
      ->add_option("drives", options->files,
                   "drive.yaml files for the experiment; without: the paper's eight drives, simulated")
      ->type_name("DRIVE.yaml");
  command->add_option("-o,--out", options->folder, "Folder for tables, report and page")
      ->required()
      ->type_name("DIR");
  command->add_option("--drives", options->presets, "Numbers of the paper's drives to simulate; default: all")
      ->delimiter(',')
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("N[,N]");
  command->add_option("--seed", options->seed, "Seed of the simulated drives; default: each preset's own");
  auto* ablation = command->add_flag(
      "--ablation", options->ablation,
      "Compare the default model with one part changed at a time, and with common alternatives, instead");
  command
      ->add_option("--consistency", options->consistency,
                   "Compare stated with actual errors, pooled over N simulated drives, instead")
      ->check(CLI::Range(1, 100000))
      ->excludes(ablation)
      ->type_name("N");
  add_common_options(*command, options->common);
  command->footer("Example:\n  waymark reproduce --out results");
  command->callback([options, &action] { action = [options] { return reproduce(*options); }; });
}

}  // namespace waymark::program
