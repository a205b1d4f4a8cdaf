#include <algorithm>
#include <filesystem>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/program/commands/commands.hpp>
#include <waymark/tools/program/jobs/pipeline.hpp>
#include <waymark/tools/program/jobs/program_registry.hpp>
#include <waymark/tools/program/jobs/report_files.hpp>
#include <waymark/tools/program/terminal/output.hpp>

namespace waymark::program {
namespace {

struct EvaluateOptions {
  CommonOptions common;
  std::vector<std::string> inputs;
  std::string truth;
  std::string data_folder;
  std::string folder;
};

/// Name of the page that `waymark evaluate -o` writes in any case.
constexpr const char* kReport = "report";

/// The files' names without folder and suffix, made different where they are not: fused, fused_2. Of several
/// files none is called as the page that compares them.
std::vector<std::string> labels_of(const std::vector<std::string>& paths) {
  std::vector<std::string> labels;
  for (const std::string& path : paths) {
    const std::string stem = std::filesystem::path(path).stem().string();
    const auto is_taken = [&](const std::string& label) {
      return std::find(labels.begin(), labels.end(), label) != labels.end() ||
             (paths.size() > 1 && label == kReport);
    };
    std::string label = stem;
    for (int n = 2; is_taken(label); ++n) {
      label = stem + "_" + std::to_string(n);
    }
    labels.push_back(label);
  }
  return labels;
}

/// Empty where their sigmas cannot be had: the graph is then not at a minimum, or not determined.
std::vector<evaluation::StateReport> states_at(const formats::GraphDocument& document) {
  try {
    return evaluation::report_states(document);
  } catch (const InputError&) {
    return {};
  }
}

/// One graph: read, compared with its truth, and, where a folder is given, told in files.
evaluation::LabelledEvaluation evaluate_file(const EvaluateOptions& options, const std::string& input,
                                             const std::string& label, const TypeRegistry& registry,
                                             const Console& console, evaluation::ReportHeader& header) {
  console.progress("evaluating " + input);
  const formats::GraphDocument document =
      formats::read_graph(formats::read_text_file(input), input, registry);
  if (document.fixes.empty()) throw InputError(input + ": has no GNSS records to evaluate at");
  const bool optimised = std::any_of(document.provenance.begin(), document.provenance.end(),
                                     [](const auto& entry) { return entry.first == "optimized"; });
  if (!optimised)
    console.note(input + " does not say that it was optimised: these are the metrics of its values");
  std::vector<TruthPose> truth;
  if (!options.truth.empty()) truth = read_truth(options.truth, options.data_folder, document, registry);
  evaluation::LabelledEvaluation evaluated{label, evaluate_document(document, truth)};
  add_provenance(document, label, header);
  if (options.folder.empty()) return evaluated;
  std::vector<std::string> files = write_trajectories(document, options.folder + "/" + label, label);
  files.push_back(write_epochs(evaluated.evaluation, options.folder + "/" + label));
  const bool alone = options.inputs.size() == 1;
  const std::string report = write_drive_report({.drive = header.drive,
                                                 .page = alone ? kReport : label,
                                                 .document = document,
                                                 .evaluated = evaluated,
                                                 .truth = truth,
                                                 .states = states_at(document),
                                                 .files = files},
                                                options.folder, console);
  for (const std::string& file : files) console.detail("written " + file);
  if (alone) {
    console.note("written " + report);
  } else {
    console.detail("written " + report);
  }
  return evaluated;
}

ExitCode evaluate_files(const EvaluateOptions& options) {
  const Console console(options.common);
  const TypeRegistry registry = make_registry_for(options.truth, options.common);
  std::vector<evaluation::LabelledEvaluation> evaluations;
  evaluation::ReportHeader header;
  const std::vector<std::string> labels = labels_of(options.inputs);
  if (!options.folder.empty()) formats::make_folder(options.folder);
  for (std::size_t i = 0; i < options.inputs.size(); ++i) {
    stop_if_interrupted();
    evaluations.push_back(evaluate_file(options, options.inputs[i], labels[i], registry, console, header));
  }
  const std::string json = evaluation::metrics_json(evaluations, header);
  if (!options.folder.empty()) {
    formats::write_file_atomically(options.folder + "/metrics.json", json);
    if (evaluations.size() > 1) {
      std::vector<ComparedReport> reports;
      for (const evaluation::LabelledEvaluation& evaluation : evaluations) reports.push_back({evaluation});
      console.note("written " + write_comparison(reports, header, options.folder, console));
    }
  }
  console.result(options.common.json ? json : evaluation::metrics_table(evaluations, console.look()));
  return kSuccess;
}

}  // namespace

void add_evaluate(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("evaluate",
                                     "Metrics of fused graphs against truth and withheld fixes\n\n"
                                     "Prints a table of errors: accuracy, precision, largest error, along "
                                     "and across the track, heading, and "
                                     "how honest the stated errors are. Without --truth the fixes that were "
                                     "kept out of the graph judge it.");
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
  add_common_options(*command, options->common);
  command->footer("Example:\n  waymark evaluate fused.graph --truth drive.yaml --out results");
  command->callback([options, &action] { action = [options] { return evaluate_files(*options); }; });
}

}  // namespace waymark::program
