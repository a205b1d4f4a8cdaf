#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <sstream>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/drive/model/minimize.hpp>
#include <waymark/tools/fleet/work/fleet_work.hpp>
#include <waymark/tools/fleet/work/process_pool.hpp>
#include <waymark/tools/fleet/work/slurm.hpp>
#include <waymark/tools/program/commands/commands.hpp>
#include <waymark/tools/program/commands/drive_options.hpp>
#include <waymark/tools/program/fleet/fleet_results.hpp>
#include <waymark/tools/program/jobs/program_registry.hpp>
#include <waymark/tools/program/manual/usage_hints.hpp>
#include <waymark/tools/program/terminal/output.hpp>
#include <waymark/version.hpp>

namespace waymark::program {
namespace {

struct FleetOptions {
  CommonOptions common;
  std::vector<std::string> words;  ///< drives, or an action and its folders
  std::string output;
  std::string label = WAYMARK_VERSION;
  std::string keep = "report";
  std::optional<std::size_t> jobs;
  std::optional<std::uint64_t> memory_mb;
  double time_limit_s = 0;
  bool retry_failed = false;
  bool slurm = false;
  std::vector<std::string> slurm_options;
  std::optional<std::size_t> per_task;
  std::optional<std::size_t> task;
  fleet::RegressionRule rule;
  // The options of `run`, which the drives get as they were given. Parsed, they are checked once.
  DriveChoice choice;
  drive::Minimization minimization;
  std::vector<std::string> run_words;
};

constexpr std::uint64_t kMegabyte = 1000 * 1000;

/// Of what is available: the system and this program need a part.
constexpr double kShareOfMemory = 0.9;

/// Returns the file of this program, for processes on this machine and others.
std::string program_file() {
  return std::filesystem::read_symlink("/proc/self/exe").string();
}

/// Paths that all drives get must lead to the same place from anywhere.
std::string made_absolute(const std::string& option, const std::string& value) {
  const bool is_path = option == "--data" || (option == "--plugin" && value.find('/') != std::string::npos);
  return is_path ? std::filesystem::absolute(value).lexically_normal().string() : value;
}

/// Returns the options for `run` as words, from those that were given.
std::vector<std::string> words_for_run(const CLI::App& command) {
  std::vector<std::string> words;
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = option->get_name();
    const bool is_for_run =
        option->get_group() == "The drive" || option->get_group() == "Optimisation" || name == "--plugin";
    if (!is_for_run || option->count() == 0) continue;
    const std::string word = "--" + option->get_lnames().front();
    if (option->get_type_size() == 0) {
      words.push_back(word);
      continue;
    }
    for (const std::string& value : option->results())
      words.push_back(word + "=" + made_absolute(word, value));
  }
  return words;
}

/// A wrong option would make every drive fail: it is found with the first drive. What is wrong with that
/// drive itself is left to its run.
void check_run_options(const FleetOptions& options, const fleet::FleetPlan& plan) {
  try {
    drive::DriveFile file = read_drive_file(plan.drives.front().path, options.choice);
    const TypeRegistry registry = make_registry(options.common, file.description.plugins);
    drive::check_minimization(options.minimization, registry);
    (void)chosen_settings(file, options.choice, registry);
  } catch (const InputError&) {
    return;
  }
}

/// Returns the drives that are named, with those in the lists "@FILE".
std::vector<std::string> named_drives(const std::vector<std::string>& words) {
  std::vector<std::string> paths;
  for (const std::string& word : words) {
    if (!word.starts_with('@')) {
      paths.push_back(word);
      continue;
    }
    std::istringstream lines(formats::read_text_file(word.substr(1)));
    for (std::string line; std::getline(lines, line);)
      if (!line.empty()) paths.push_back(line);
  }
  return paths;
}

/// Writes the plan, or finds that it goes on with the one that is there.
fleet::FleetPlan begin_plan(const FleetOptions& options, const fleet::FleetFolder& folder) {
  fleet::FleetPlan plan{.label = options.label,
                        .options = options.run_words,
                        .keep = fleet::keep_from_string(options.keep),
                        .drives = fleet::find_drives(named_drives(options.words))};
  if (plan.drives.empty()) throw UsageError("there are no drives in the lists");
  check_run_options(options, plan);
  const std::size_t least = (plan.drives.size() + fleet::kMostTasks - 1) / fleet::kMostTasks;
  plan.per_task = std::max<std::size_t>(1, options.per_task.value_or(least));
  formats::make_folder(folder.path());
  if (std::filesystem::exists(folder.plan())) {
    const std::string other = fleet::difference(fleet::read_plan(folder), plan);
    if (!other.empty())
      throw UsageError(fmt::format("{}: holds a fleet with other results: {}; choose another folder",
                                   folder.path(), other));
  }
  formats::write_file_atomically(folder.plan(), fleet::plan_json(plan));
  return plan;
}

fleet::WorkSettings work_settings(const FleetOptions& options, const fleet::FleetFolder& folder,
                                  fleet::FleetPlan plan) {
  const std::size_t at_once = options.jobs.value_or(options.task ? 1 : fleet::usable_processors());
  std::uint64_t memory = options.memory_mb.value_or(0) * kMegabyte;
  if (!options.memory_mb && !options.task)  // a task has the limit of its cluster
    memory = static_cast<std::uint64_t>(kShareOfMemory * static_cast<double>(fleet::available_memory()));
  return {.folder = folder,
          .plan = std::move(plan),
          .program = program_file(),
          .program_version = "waymark " WAYMARK_VERSION,
          .codes = {kSuccess, kNotConverged, kOutputError, kInterrupted},
          .lack_of_memory = {kLackOfMemory.begin(), kLackOfMemory.end()},
          .at_once = at_once,
          .memory_bytes = memory,
          .time_limit_s = options.time_limit_s,
          .task = options.task,
          .retry_failed = options.retry_failed};
}

/// Works, and tells of each drive as it ends.
fleet::WorkReport work_and_tell(const fleet::WorkSettings& settings, const Console& console) {
  ProgressMeter meter;
  std::size_t failed = 0;
  const fleet::WorkReport report = fleet::work(
      settings, interrupted, [&](const fleet::DriveRecord& record, std::size_t ended, std::size_t due) {
        if (record.state == fleet::DriveState::failed) {
          ++failed;
          console.warning(fmt::format("drive {} failed: {}", record.drive, record.reason));
        } else {
          console.detail(fmt::format("{} {}, {:.1f} s", record.drive, fleet::to_string(record.state),
                                     record.cost.wall_s));
        }
        meter.update(static_cast<double>(ended), static_cast<double>(due));
        console.progress(
            fmt::format("{} of {} drives, {} failed{}{}", ended, due, failed,
                        meter.rate() ? fmt::format(", {:.1f} per minute", 60 * *meter.rate()) : "",
                        remaining_text(meter)));
      });
  console.end_progress();
  if (report.changed > 0)
    console.note(fmt::format("{} drives were run again, because their drive.yaml changed", report.changed));
  return report;
}

ExitCode finish(const fleet::Fleet& fleet, const std::string& folder, const std::vector<std::string>& files,
                const Console& console) {
  std::string written = files.empty() ? "" : "\nwritten:\n";
  for (const std::string& file : files) written += "  " + file + "\n";
  console.result(console.json() ? json_document("fleet", status_json(fleet, folder, files))
                                : status_text(fleet, folder, console.look()) + written);
  return exit_code_of(fleet);
}

ExitCode merge(const std::string& path, const Console& console) {
  const fleet::Fleet fleet = fleet::read_fleet(path);
  if (fleet.records.empty()) throw InputError(path + ": no drive of this fleet has ended yet");
  if (fleet.waiting() > 0)
    console.warning(fmt::format("{} of {} drives have not ended; the table lacks them", fleet.waiting(),
                                fleet.plan.drives.size()));
  return finish(fleet, path, write_merged(fleet, path, console), console);
}

ExitCode run_local(const FleetOptions& options, const fleet::FleetFolder& folder, fleet::FleetPlan plan,
                   const Console& console) {
  const fleet::WorkReport report = work_and_tell(work_settings(options, folder, std::move(plan)), console);
  if (report.ended_before > 0) console.note(fmt::format("{} drives had ended before", report.ended_before));
  if (!report.interrupted) return merge(folder.path(), console);
  console.warning("interrupted: what has ended is kept; the same command goes on with the others");
  (void)finish(fleet::read_fleet(folder.path()), folder.path(), {}, console);
  return kInterrupted;
}

ExitCode run_on_cluster(const FleetOptions& options, const fleet::FleetFolder& folder,
                        const fleet::FleetPlan& plan, const Console& console) {
  const std::vector<std::size_t> tasks = fleet::tasks_due(plan, folder, options.retry_failed);
  if (tasks.empty()) return merge(folder.path(), console);
  const fleet::SlurmSettings settings{.program = program_file(),
                                      .processors = options.jobs.value_or(1),
                                      .memory_mb = options.memory_mb.value_or(0),
                                      .options = options.slurm_options,
                                      .time_limit_s = options.time_limit_s,
                                      .retry_failed = options.retry_failed};
  formats::make_folder(folder.slurm());
  formats::write_file_atomically(folder.slurm_script(), fleet::slurm_script(plan, folder, tasks, settings));
  const std::string job = fleet::submit(folder);
  console.tell(
      fmt::format("submitted job {} of {} tasks; `waymark fleet status {}` says how far it is, and "
                  "`waymark fleet merge {}` writes the results",
                  job, tasks.size(), folder.path(), folder.path()));
  (void)finish(fleet::read_fleet(folder.path()), folder.path(), {folder.slurm_script()}, console);
  return kSuccess;
}

ExitCode run_fleet(const FleetOptions& options, const Console& console) {
  if (options.output.empty()) throw UsageError("--out is required: the folder of the fleet");
  const fleet::FleetFolder folder(std::filesystem::absolute(options.output).lexically_normal().string());
  formats::make_folder(folder.path());
  const fleet::FleetLock lock(folder);
  fleet::FleetPlan plan = begin_plan(options, folder);
  if (options.slurm) return run_on_cluster(options, folder, plan, console);
  return run_local(options, folder, std::move(plan), console);
}

/// A task of a cluster. Drives that fail are its result, no failure of its own: Slurm must not think so.
ExitCode run_task(const FleetOptions& options, const Console& console) {
  if (!options.task) throw UsageError("--task is required: the number of the task");
  const fleet::FleetFolder folder(options.words[1]);
  const fleet::WorkReport report =
      work_and_tell(work_settings(options, folder, fleet::read_plan(folder)), console);
  console.result(fmt::format("task {}: {} drives ended, {} had ended before\n", *options.task, report.ended,
                             report.ended_before));
  return report.interrupted ? kInterrupted : kSuccess;
}

ExitCode compare_two(const FleetOptions& options, const Console& console) {
  if (options.output.empty()) throw UsageError("--out is required: the folder of the comparison");
  const fleet::Regression regression = fleet::compare_fleets(
      fleet::read_fleet(options.words[1]), fleet::read_fleet(options.words[2]), options.rule);
  const std::vector<std::string> files = write_regression(regression, options.output);
  console.result(console.json()
                     ? json_document("fleet-comparison", regression_json(regression, files))
                     : fmt::format("{}\nwritten:\n  {}\n  {}\n", regression_text(regression, console.look()),
                                   files[0], files[1]));
  return kSuccess;
}

ExitCode show_status(const std::string& path, const Console& console) {
  (void)finish(fleet::read_fleet(path), path, {}, console);
  return kSuccess;
}

/// @throws UsageError
void require_words(const FleetOptions& options, std::size_t count, const char* usage) {
  if (options.words.size() != count) throw UsageError(fmt::format("type: waymark fleet {}", usage));
}

ExitCode dispatch(const FleetOptions& options) {
  const Console console(options.common);
  const std::string& action = options.words.front();
  if (action == "status") {
    require_words(options, 2, "status DIR");
    return show_status(options.words[1], console);
  }
  if (action == "merge") {
    require_words(options, 2, "merge DIR");
    return merge(options.words[1], console);
  }
  if (action == "work") {
    require_words(options, 2, "work DIR --task N");
    return run_task(options, console);
  }
  if (action == "compare") {
    require_words(options, 3, "compare OLD NEW -o DIR");
    return compare_two(options, console);
  }
  return run_fleet(options, console);
}

void add_work_options(CLI::App& command, FleetOptions& options) {
  const OptionHeading heading(command, "The fleet");
  command.add_option("--label", options.label, "Name of the fleet in tables, such as a commit")
      ->type_name("NAME")
      ->capture_default_str();
  command
      .add_option("--keep", options.keep,
                  "Results of a drive to keep: all files, the report, or only the metrics")
      ->check(one_of("word", {"all", "report", "metrics"}))
      ->capture_default_str();
  command.add_option("-j,--jobs", options.jobs, "Drives at once (default: one per processor; in a task 1)")
      ->check(CLI::Range(1, 4096));
  command
      .add_option("--memory", options.memory_mb,
                  "Megabytes that all drives together may have (default: nine tenths of what is available)")
      ->type_name("MB");
  command
      .add_option("--time-limit", options.time_limit_s,
                  "Kill a drive that runs longer, such as 90s, 20min or 1h; it has failed (default: none)")
      ->type_name("TIME")
      ->transform(CLI::AsNumberWithUnit(std::map<std::string, double>{{"s", 1}, {"min", 60}, {"h", 3600}},
                                        CLI::AsNumberWithUnit::UNIT_OPTIONAL)
                      .description(""))
      ->check(CLI::Range(0.1, 1e8).description(""));
  command.add_flag("--retry-failed", options.retry_failed, "Run drives again that failed before");
}

void add_cluster_options(CLI::App& command, FleetOptions& options) {
  const OptionHeading heading(command, "A cluster with Slurm");
  command.add_flag("--slurm", options.slurm, "Submit a job array, instead of running drives here");
  command
      .add_option("--slurm-option", options.slurm_options,
                  "Option of sbatch, such as --slurm-option=--partition=long (may be repeated)")
      ->type_name("OPTION")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command.add_option("--per-task", options.per_task, "Drives of a task (default: as few as 1000 tasks need)")
      ->check(CLI::Range(1, 1000000));
  command.add_option("--task", options.task, "Number of the task, for 'work'")->type_name("N");
}

void add_rule_options(CLI::App& command, fleet::RegressionRule& rule) {
  const OptionHeading heading(command, "When a drive got worse, for 'compare'");
  command.add_option("--worse-percent", rule.percent, "Its error grew by more than this, in percent ...")
      ->type_name("PERCENT")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command.add_option("--worse-by", rule.length_m, "... and by more than this, in metres")
      ->type_name("METRES")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
}

}  // namespace

void add_fleet(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "fleet",
      "Run hundreds of drives, here or on a cluster, and compare them\n\n"
      "Runs every drive as 'waymark run' does, in a process of its own, and merges their numbers into one "
      "table and one page. A folder stands for every drive.yaml below it, @FILE for the paths in a file. A "
      "drive that fails is reported, and the others go on. The same command goes on where it was stopped.\n\n"
      "'fleet status DIR' says how far a fleet is. 'fleet merge DIR' writes table and page. 'fleet compare "
      "OLD NEW -o DIR' says which drives got worse between two fleets of the same drives. 'fleet work DIR "
      "--task N' runs a share of the drives, as tasks of a cluster do.");
  const auto options = std::make_shared<FleetOptions>();
  command->add_option("drives", options->words, "Drives and folders of drives; or an action and its folders")
      ->required()
      ->type_name("DRIVE.yaml|DIR|status|merge|compare|work");
  command->add_option("-o,--out", options->output, "Folder of the fleet, or of the comparison")
      ->type_name("DIR");
  add_work_options(*command, *options);
  add_cluster_options(*command, *options);
  add_rule_options(*command, options->rule);
  add_drive_options(*command, options->choice);
  add_optimization_options(*command, options->minimization);
  add_common_options(*command, options->common);
  command->footer(
      "Example:\n  waymark fleet drives -o fleet --label main\n  waymark fleet compare fleet_old fleet -o changes");
  command->callback([options, command, &action] {
    options->run_words = words_for_run(*command);
    action = [options] { return dispatch(*options); };
  });
}

}  // namespace waymark::program
