#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/graph/graph_text.hpp>
#include <waymark/formats/text/folder_lock.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/drive/description/drive_file.hpp>
#include <waymark/tools/drive/model/poses_at_fixes.hpp>
#include <waymark/tools/program/commands/commands.hpp>
#include <waymark/tools/program/commands/drive_options.hpp>
#include <waymark/tools/program/jobs/evaluation/document_evaluation.hpp>
#include <waymark/tools/program/jobs/evaluation/map_file.hpp>
#include <waymark/tools/program/jobs/graph/optimization.hpp>
#include <waymark/tools/program/jobs/program_registry.hpp>
#include <waymark/tools/program/jobs/result_files.hpp>
#include <waymark/tools/program/terminal/output.hpp>

namespace waymark::program {
namespace {

struct EvaluateOptions {
  CommonOptions common;
  std::vector<std::string> inputs;
  std::string truth;
  std::string data_folder;
  std::string folder;
  std::string map;  ///< beneath the trajectory; empty: none
};

/// Returns the names of the files without folder and suffix. Equal names are made different: fused,
/// fused_2. With several files, none gets the name of the page that compares them.
std::vector<std::string> labels_of(const std::vector<std::string>& paths) {
  std::vector<std::string> labels;
  for (const std::string& path : paths) {
    const std::string stem = std::filesystem::path(path).stem().string();
    const auto is_taken = [&](const std::string& label) {
      return std::find(labels.begin(), labels.end(), label) != labels.end() ||
             (paths.size() > 1 && label == evaluation::ResultFolder::kReport);
    };
    std::string label = stem;
    for (int n = 2; is_taken(label); ++n) {
      label = stem + "_" + std::to_string(n);
    }
    labels.push_back(label);
  }
  return labels;
}

/// Returns the states with sigmas. Empty if these cannot be computed: the graph is then not at a
/// minimum, or undetermined.
std::vector<evaluation::StateReport> states_at(const formats::GraphDocument& document) {
  try {
    return evaluation::report_states(document);
  } catch (const InputError&) {
    return {};
  }
}

/// The data for the evaluation of all graphs of a command.
struct EvaluationJob {
  const EvaluateOptions& options;
  /// empty: there is no truth, or it is a TUM file
  const std::optional<drive::DriveFile>& truth_file;
  const TypeRegistry& registry;
  const Console& console;
};

std::vector<TruthPose> truth_of(const formats::GraphDocument& document, const EvaluationJob& job) {
  if (job.truth_file) return truth_for(document, job.truth_file->description, job.registry);
  return job.options.truth.empty() ? std::vector<TruthPose>() : truth_from_tum(job.options.truth);
}

/// Warns of truth that covers a part of the trajectory only. @throws InputError if it covers none
void judge_coverage(const std::vector<TruthPose>& truth, formats::GraphDocument& document,
                    const EvaluationJob& job) {
  std::string place = job.options.truth + ": ";
  std::string remedy = "its stamps are seconds on the scale of the graph";
  if (job.truth_file && job.truth_file->description.truth) {
    place = job.truth_file->description.truth->place;
    remedy = "check 'time: {scale, week, offset}' of the truth, and whether the graph is of this drive";
  }
  const std::string warning = partial_truth_warning(document, truth, place, remedy);
  if (!warning.empty()) warn(warning, document, job.console);
}

formats::GraphDocument read_fused(const std::string& input, const EvaluationJob& job) {
  job.console.progress("evaluating " + input);
  formats::GraphDocument document =
      formats::read_graph(formats::read_graph_text(input, job.registry), input, job.registry);
  if (drive::evaluated_vertices(document).empty())
    throw InputError(input + ": has neither GNSS records nor poses with stamps to evaluate at");
  const bool optimised = std::any_of(document.provenance.begin(), document.provenance.end(),
                                     [](const auto& entry) { return entry.first == "optimized"; });
  if (!optimised)
    job.console.note(input + " has no note that it was optimised: these are the metrics of its values");
  return document;
}

/// Evaluates one graph: reads it, compares it with its truth, and writes files if there
/// is a folder.
evaluation::LabelledEvaluation evaluate_file(const EvaluationJob& job, const std::string& input,
                                             const std::string& label, evaluation::ReportHeader& header) {
  const Console& console = job.console;
  formats::GraphDocument document = read_fused(input, job);
  const std::vector<TruthPose> truth = truth_of(document, job);
  judge_coverage(truth, document, job);
  evaluation::LabelledEvaluation evaluated{label, evaluate_document(document, truth)};
  const bool reports = !job.options.folder.empty();
  const MapFile map =
      read_map_file(job.options.map, document.frame.value_or(Frame{}), positions_of(document));
  std::optional<evaluation::Sparsity> sparsity;
  if (reports) sparsity = sparsity_for_report(document, console);
  add_provenance(document, label, header);
  if (!reports) return evaluated;
  const WrittenResult written =
      write_result({.drive = header.drive,
                    .document = document,
                    .evaluated = evaluated,
                    .truth = truth,
                    .states = states_at(document),
                    .sparsity = std::move(sparsity),
                    .map = &map},
                   evaluation::ResultFolder(job.options.folder), job.options.inputs.size(), console);
  for (const std::string& file : written.files) console.detail("written " + file);
  if (job.options.inputs.size() == 1) {
    console.note("written " + written.page);
  } else {
    console.detail("written " + written.page);
  }
  return evaluated;
}

/// Returns the drive.yaml that names the truth, if there is one.
std::optional<drive::DriveFile> read_truth_file(const EvaluateOptions& options) {
  if (!drive::is_drive_file(options.truth)) return std::nullopt;
  return drive::load_drive_file(options.truth, options.data_folder);
}

ExitCode evaluate_files(const EvaluateOptions& options) {
  const Console console(options.common);
  const std::optional<drive::DriveFile> truth_file = read_truth_file(options);
  const TypeRegistry registry = make_registry(
      options.common, truth_file ? truth_file->description.plugins : std::vector<std::string>());
  const EvaluationJob job{options, truth_file, registry, console};
  std::vector<evaluation::LabelledEvaluation> evaluations;
  evaluation::ReportHeader header;
  const std::vector<std::string> labels = labels_of(options.inputs);
  std::optional<formats::FolderLock> lock;
  if (!options.folder.empty()) {
    formats::make_folder(options.folder);
    lock.emplace(options.folder);
  }
  for (std::size_t i = 0; i < options.inputs.size(); ++i) {
    stop_if_interrupted();
    evaluations.push_back(evaluate_file(job, options.inputs[i], labels[i], header));
  }
  const std::string json = evaluation::metrics_json(evaluations, header);
  if (!options.folder.empty()) {
    std::vector<ComparedResult> results;
    for (const evaluation::LabelledEvaluation& evaluation : evaluations) results.push_back({evaluation});
    const std::vector<std::string> files =
        write_overview(results, header, json, evaluation::ResultFolder(options.folder), console);
    if (evaluations.size() > 1) console.note("written " + files.front());
  }
  console.result(options.common.json ? json : evaluation::metrics_table(evaluations, console.look()));
  return kSuccess;
}

}  // namespace

void add_evaluate(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("evaluate",
                                     "Compare fused graphs with truth and withheld fixes\n\n"
                                     "Prints a table of errors: accuracy, precision, largest error, "
                                     "along and across the track, heading, and whether the stated "
                                     "errors are consistent (NEES). Without --truth the errors are "
                                     "against the fixes that were kept out of the graph.");
  const auto options = std::make_shared<EvaluateOptions>();
  command->add_option("graphs", options->inputs, "Optimised .graph files")->required()->type_name("GRAPH");
  command
      ->add_option("--truth", options->truth,
                   "Truth: a drive.yaml with a truth section, or a TUM file in the frame")
      ->type_name("DRIVE.yaml|FILE");
  command->add_option("--data", options->data_folder, "Folder of the logs, instead of the drive.yaml's own")
      ->type_name("DIR");
  command->add_option("-o,--out", options->folder, "Folder for the report, metrics.json and the trajectories")
      ->type_name("DIR");
  add_map_option(*command, options->map);
  add_common_options(*command, options->common);
  command->footer("Example:\n  waymark evaluate fused.graph --truth drive.yaml --out results");
  command->callback([options, &action] { action = [options] { return evaluate_files(*options); }; });
}

}  // namespace waymark::program
