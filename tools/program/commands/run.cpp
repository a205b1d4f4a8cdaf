#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <waymark/tools/evaluation/output/report.hpp>
#include <waymark/tools/program/commands/commands.hpp>
#include <waymark/tools/program/commands/drive_options.hpp>
#include <waymark/tools/program/jobs/drive/drive_run.hpp>
#include <waymark/tools/program/jobs/drive/drive_text.hpp>
#include <waymark/tools/program/jobs/graph/optimization.hpp>
#include <waymark/tools/program/jobs/program_registry.hpp>

namespace waymark::program {
namespace {

struct RunOptions {
  CommonOptions common;
  DriveChoice choice;
  drive::Minimization minimization;
  std::string input;
  DriveRunOptions job;
};

std::string run_line(const std::string& modeling, const Summary& s) {
  return fmt::format("{:<11} {} in {} iterations, {:.3f} s, chi2 {:.10g} -> {:.10g}{}\n", modeling,
                     s.converged() ? "converged" : "NOT CONVERGED", s.iterations, s.total_seconds,
                     s.initial_chi2, s.final_chi2, s.converged() ? "" : " (" + s.message + ")");
}

std::string describe_runs(const DriveRun& run, const Console& console) {
  std::string text = describe_drive(run.loaded.drive);
  std::vector<std::string> described;
  for (const ModelingRun& of : run.modelings) {
    const bool known = std::any_of(described.begin(), described.end(), [&](const std::string& earlier) {
      return earlier.starts_with(of.description);
    });
    if (!known) text += described.emplace_back(of.description);
    text +=
        run_line(of.evaluation.label, of.result.summary) + evaluation::states_text(of.states, console.look());
  }
  return text;
}

/// Returns the verdict of each modeling, and where to read on.
std::string verdicts(const std::vector<ModelingRun>& runs, const std::string& page) {
  std::string text = "\n";
  for (const ModelingRun& of : runs) {
    if (runs.size() > 1) text += of.evaluation.label + ": ";
    text += of.written.verdict + "\n";
  }
  return text + "Read on in " + page + "\n";
}

/// Returns the printed text of a run: its modelings, the metrics, the files, and the verdict last,
/// where the eye is when the program has ended.
std::string run_text(const evaluation::ResultFolder& folder, const DriveRun& run, const Console& console) {
  const std::string page = folder.page(folder.kReport);
  std::string text = describe_runs(run, console) + "\n" +
                     evaluation::metrics_table(run.evaluations, console.look()) + "\nwritten:\n  " + page +
                     "\n";
  for (const ModelingRun& of : run.modelings) {
    if (of.written.page != page) text += "  " + of.written.page + "\n";
    for (const std::string& file : of.written.files) text += "  " + file + "\n";
  }
  for (const std::string& file : run.common_files)
    if (file != page) text += "  " + file + "\n";
  return text + "  and the figures of the report as SVG and CSV in " + folder.figures() + "\n" +
         verdicts(run.modelings, page);
}

/// A modeling without a minimum is a failure, and so is an interrupted run.
ExitCode exit_code_of(const DriveRun& run) {
  ExitCode code = kSuccess;
  for (const ModelingRun& of : run.modelings) {
    const ExitCode of_run = exit_code(of.result.summary);
    if (of_run != kSuccess) code = of_run;
  }
  return interrupted ? kInterrupted : code;
}

ExitCode run_and_print(const RunOptions& options) {
  const Console console(options.common);
  drive::DriveFile file = read_drive_file(options.input, options.choice);
  file.settings.minimization = options.minimization;
  const TypeRegistry registry = make_registry(options.common, file.description.plugins);
  const DriveRun run = run_drive(file, options.choice, options.job, registry, console);
  std::string windows;
  for (const ModelingRun& of : run.modelings) windows += of.windows;
  console.result(options.common.json
                     ? run.metrics
                     : windows + run_text(evaluation::ResultFolder(*options.job.folder), run, console));
  return exit_code_of(run);
}

}  // namespace

void add_run(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "run",
      "Convert, optimise and evaluate a drive\n\n"
      "Reads the logs that the drive.yaml names, builds the graph, optimises it and compares the "
      "result with truth and with the withheld fixes. The folder then holds graphs, trajectories "
      "and metrics of each modeling.");
  const auto options = std::make_shared<RunOptions>();
  command->add_option("drive", options->input, "drive.yaml of the drive")
      ->required()
      ->type_name("DRIVE.yaml");
  command->add_option("-o,--out", options->job.folder, "Folder for all results")
      ->required()
      ->type_name("DIR");
  add_drive_options(*command, options->choice);
  {
    const OptionHeading heading(*command, "The drive");
    command->add_flag("--causal", options->job.causal,
                      "Also predict each outage of --outage without later data");
    command
        ->add_option("--window", options->job.windows_s,
                     "Also fuse as 'live' does, in windows of so many seconds: 1,5,15,60,300")
        ->type_name("SECONDS[,...]")
        ->delimiter(',')
        ->check(CLI::Range(1.0, 1e5));
  }
  add_optimization_options(*command, options->minimization);
  {
    const OptionHeading heading(*command, "The report");
    add_map_option(*command, options->job.map);
  }
  add_common_options(*command, options->common);
  command->footer("Example:\n  waymark run drive.yaml --out results --modeling all");
  command->callback([options, &action] { action = [options] { return run_and_print(*options); }; });
}

}  // namespace waymark::program
