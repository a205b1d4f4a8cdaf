#include <algorithm>

#include <fmt/format.h>

#include <waymark/formats/text/folder_lock.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/evaluation/output/result_folder.hpp>
#include <waymark/tools/program/commands/commands.hpp>
#include <waymark/tools/program/terminal/output.hpp>
#include <waymark/tools/report/comparison/comparison_page.hpp>
#include <waymark/version.hpp>

namespace waymark::program {
namespace {

struct CompareOptions {
  CommonOptions common;
  std::vector<std::string> folders;
  std::string output;
};

std::vector<std::string> drives_of(const std::vector<report::ComparedRun>& runs) {
  std::vector<std::string> drives;
  for (const report::ComparedRun& run : runs)
    if (std::find(drives.begin(), drives.end(), run.drive) == drives.end()) drives.push_back(run.drive);
  return drives;
}

/// Prints what the reader must know before the numbers.
void tell_limits(const std::vector<report::ComparedRun>& runs, const Console& console) {
  const std::vector<std::string> drives = drives_of(runs);
  if (drives.size() > 1) {
    std::string names;
    for (const std::string& drive : drives) names.append(names.empty() ? "" : ", ").append(drive);
    console.note(fmt::format("the runs are of {} drives ({}): errors are comparable only within one drive",
                             drives.size(), names));
    if (drives.size() == runs.size()) console.note("no two runs are of one drive");
  }
  const bool judged = std::any_of(runs.begin(), runs.end(), [](const report::ComparedRun& run) {
    return run.evaluation.truth || run.evaluation.withheld_fixes;
  });
  if (!judged)
    console.note(
        "no run has a truth or withheld fixes, so there are no errors to compare; see "
        "`waymark run --withhold` and `waymark evaluate --truth`");
}

/// Returns the runs in the schema of `run`, under their labels here.
std::string merged_metrics(const std::vector<report::ComparedRun>& runs) {
  const std::vector<std::string> drives = drives_of(runs);
  evaluation::ReportHeader header{drives.size() == 1 ? drives.front() : "", {}};
  std::vector<evaluation::LabelledEvaluation> evaluations;
  for (const report::ComparedRun& run : runs) {
    evaluations.push_back({run.label, run.evaluation});
    header.provenance[run.label + ".drive"] = run.drive;
    for (const auto& [key, text] : run.provenance) header.provenance[run.label + "." + key] = text;
  }
  return evaluation::metrics_json(evaluations, header);
}

ExitCode compare(const CompareOptions& options) {
  const Console console(options.common);
  std::vector<report::ComparedRun> runs = report::read_compared_runs(options.folders);
  tell_limits(runs, console);
  const drawing::Page page = report::comparison_page(runs, WAYMARK_VERSION);
  formats::make_folder(options.output);
  const formats::FolderLock lock(options.output);
  const evaluation::ResultFolder folder(options.output);
  std::vector<std::string> files =
      drawing::write_page(page, folder.path(), evaluation::ResultFolder::kComparison);
  const std::string json = merged_metrics(runs);
  files.push_back(folder.metrics());
  formats::write_file_atomically(files.back(), json);
  if (options.common.json) {
    console.result(json);
    return kSuccess;
  }
  std::vector<evaluation::LabelledEvaluation> evaluations;
  for (report::ComparedRun& run : runs) evaluations.push_back({run.label, std::move(run.evaluation)});
  console.result(fmt::format("{}\nwritten:\n  {}\n  {}\n  {} figures as SVG and CSV in {}\n",
                             evaluation::metrics_table(evaluations, console.look()), files.front(),
                             files.back(), drawing::figures_of(page).size(), folder.figures()));
  return kSuccess;
}

}  // namespace

void add_compare(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "compare",
      "Write one report of several runs: modelings, settings, drives\n\n"
      "Reads the folders that 'run' and 'evaluate' wrote. The report shows their errors beside each "
      "other and beside raw GNSS, and the settings that differ. Errors are comparable "
      "only within one drive.");
  const auto options = std::make_shared<CompareOptions>();
  command->add_option("runs", options->folders, "Folders that `run -o` or `evaluate -o` wrote")
      ->required()
      ->type_name("RUN");
  command->add_option("-o,--out", options->output, "Folder for comparison.html, its figures and metrics.json")
      ->required()
      ->type_name("DIR");
  add_common_options(*command, options->common);
  command->footer("Example:\n  waymark compare results/g1 results/no_gate --out comparison");
  command->callback([options, &action] { action = [options] { return compare(*options); }; });
}

}  // namespace waymark::program
