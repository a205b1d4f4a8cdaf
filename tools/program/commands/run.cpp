#include <algorithm>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/program/commands/commands.hpp>
#include <waymark/tools/program/commands/drive_options.hpp>
#include <waymark/tools/program/jobs/graph/covariance.hpp>
#include <waymark/tools/program/jobs/model_report.hpp>
#include <waymark/tools/program/jobs/program_registry.hpp>
#include <waymark/tools/program/jobs/report_files.hpp>
#include <waymark/tools/program/jobs/result_doubts.hpp>
#include <waymark/tools/program/terminal/output.hpp>

namespace waymark::program {
namespace {

struct RunOptions {
  CommonOptions common;
  DriveOverrides overrides;
  OptimizationChoice choice;
  std::string input;
  std::string folder;
  bool causal = false;
};

/// One modeling of the drive: graph, optimum, evaluation, files.
struct ModelingRun {
  evaluation::LabelledEvaluation evaluation;
  MultiStartSummary result;
  std::vector<evaluation::StateReport> states;
  drive::NoiseEstimate noise;
  std::string description;  ///< of the error model
  std::vector<std::string> files;
};

/// Covariances of the poses at the fixes, for the evaluation; said where there are none.
void add_covariances_at_fixes(formats::GraphDocument& document, const Summary& summary,
                              const Console& console) {
  if (!summary.converged() || !document.covariances.empty()) return;
  try {
    add_covariances(document, "fixes");
  } catch (const InputError& error) {
    console.warning("stated errors cannot be judged: " + std::string(error.what()));
  }
}

/// What was known of the withheld fixes before each outage's end: the same settings on the drive so far.
evaluation::Prediction predict_causally(const RunOptions& options, const LoadedDrive& loaded,
                                        const std::string& modeling, const TypeRegistry& registry,
                                        const Console& console) {
  OptimizationChoice choice = options.choice;
  choice.covariance = "fixes";
  const auto runs = drive::withheld_runs(loaded.drive.fixes);
  const auto outages = std::count_if(runs.begin(), runs.end(), [](const auto& run) { return run.begin > 0; });
  StepProgress progress(console, static_cast<std::size_t>(outages));
  const drive::FuseDrive fuse =
      [&](const drive::PreparedDrive& known) -> std::optional<formats::GraphDocument> {
    if (interrupted) return std::nullopt;
    progress.next(fmt::format("{}: causal, outage {} of {}", modeling, progress.step() + 1, outages));
    try {
      formats::GraphDocument document =
          drive::model_drive(known, loaded.config, modeling,
                             known_options(modeling, options.overrides, registry), registry, loaded.loss)
              .document;
      const Summary summary =
          optimize_document(document, choice, registry, console, {}, progress.line()).summary;
      if (summary.termination == Termination::interrupted) return std::nullopt;
      return document;
    } catch (const InputError& error) {
      console.warning(fmt::format("nothing is known causally of the outage that ends with epoch {}: {}",
                                  known.fixes.back().epoch, error.what()));
      return std::nullopt;
    }
  };
  evaluation::Prediction causal = as_prediction("causal", drive::causal_at_withheld(loaded.drive, fuse));
  if (interrupted) console.warning("interrupted: the causal predictions end early");
  return causal;
}

ModelingRun run_modeling(const RunOptions& options, const LoadedDrive& loaded, drive::ModeledDrive modeled,
                         const TypeRegistry& registry, const Console& console,
                         evaluation::ReportHeader& header) {
  const std::string& modeling = modeled.modeling;
  ModelingRun run;
  const std::string prefix = options.folder + "/" + modeling;
  run.noise = modeled.noise;
  run.description = describe_model(modeled, console.look());
  formats::GraphDocument& document = modeled.document;
  const auto write = [&](const std::string& name) {
    formats::write_file_atomically(
        name, [&](const formats::TextSink& sink) { formats::write_graph(document, registry, sink); });
    run.files.push_back(name);
  };
  write(prefix + ".graph");
  console.detail("optimising " + modeling);
  run.result = optimize_document(document, options.choice, registry, console, {}, modeling);
  document.provenance.emplace_back("optimized", describe_optimization(run.result));
  write(prefix + ".fused.graph");
  run.states = states_of_minimum(document, run.result.summary, console);
  for (const std::string& file : write_trajectories(document, prefix, modeling)) run.files.push_back(file);
  console.progress(modeling + ": covariances");
  add_covariances_at_fixes(document, run.result.summary, console);
  std::vector<evaluation::Prediction> further;
  if (options.causal) further.push_back(predict_causally(options, loaded, modeling, registry, console));
  run.evaluation = {modeling, evaluate_document(document, loaded.drive.truth, further)};
  run.files.push_back(write_epochs(run.evaluation.evaluation, prefix));
  console.end_progress();
  for (const std::string& warning : doubts_of_result(run.states, run.noise, run.evaluation.evaluation)) {
    console.warning(warning);
    document.provenance.emplace_back("warning", warning);
  }
  add_provenance(document, modeling, header);
  const bool alone = loaded.modelings.size() == 1;
  run.files.push_back(write_drive_report(
      {.drive = loaded.config.name,
       .page = alone ? "report" : modeling,
       .document = document,
       .evaluated = run.evaluation,
       .truth = loaded.drive.truth,
       .optimization = &run.result,
       .states = run.states,
       .went_in = {{"odometry", odometry_in_words(loaded)}, {"left out", left_out(loaded)}},
       .files = run.files},
      options.folder, console));
  return run;
}

std::string run_line(const std::string& modeling, const Summary& s) {
  return fmt::format("{:<11} {} in {} iterations, {:.3f} s, chi2 {:.10g} -> {:.10g}{}\n", modeling,
                     s.converged() ? "converged" : "NOT CONVERGED", s.iterations, s.total_seconds,
                     s.initial_chi2, s.final_chi2, s.converged() ? "" : " (" + s.message + ")");
}

/// Files of every modeling, after its name; those of the whole run.
constexpr const char* kOfModeling[] = {".graph", ".fused.graph", ".csv",        ".tum", ".geojson",
                                       ".kml",   ".gpx",         ".epochs.csv", ".html"};
constexpr const char* kOfRun[] = {"report.html", "metrics.json", "summary.json"};

void require_logs_stay(const RunOptions& options, const LoadedDrive& loaded) {
  const std::string folder = options.folder + "/";
  for (const std::string& modeling : loaded.modelings) {
    for (const char* ending : kOfModeling) require_not_read(folder + modeling + ending, loaded.files);
  }
  for (const char* name : kOfRun) require_not_read(folder + name, loaded.files);
}

/// The modelings of a drive; what is wrong with one of them shows before anything is written.
std::vector<drive::ModeledDrive> model_all(const RunOptions& options, const LoadedDrive& loaded,
                                           const TypeRegistry& registry, const Console& console) {
  std::vector<drive::ModeledDrive> models;
  for (const std::string& modeling : loaded.modelings) {
    models.push_back(model_loaded(loaded, modeling, known_options(modeling, options.overrides, registry),
                                  registry, console));
    stop_if_interrupted();
  }
  return models;
}

/// What all modelings have in common: the comparison, metrics.json, summary.json. Returns the files.
std::vector<std::string> write_common(const std::vector<ModelingRun>& runs, const std::string& metrics,
                                      const evaluation::ReportHeader& header, const std::string& folder,
                                      const Console& console) {
  std::vector<std::string> files;
  if (runs.size() > 1) {
    std::vector<ComparedReport> reports;
    for (const ModelingRun& run : runs) reports.push_back({run.evaluation, &run.result});
    files.push_back(write_comparison(reports, header, folder, console));
  }
  nlohmann::ordered_json summaries;
  for (const ModelingRun& run : runs) {
    nlohmann::ordered_json& summary = summaries[run.evaluation.label];
    summary = summary_json(run.result);
    summary["states"] = evaluation::states_json(run.states);
    summary["noise"] = noise_json(run.noise);
  }
  files.push_back(folder + "/metrics.json");
  formats::write_file_atomically(files.back(), metrics);
  files.push_back(folder + "/summary.json");
  formats::write_file_atomically(files.back(), json_text(summaries));
  return files;
}

std::string describe_runs(const LoadedDrive& loaded, const std::vector<ModelingRun>& runs,
                          const Console& console) {
  std::string text = describe_drive(loaded);
  for (const ModelingRun& run : runs) {
    if (text.find(run.description) == std::string::npos) text += run.description;
    text += run_line(run.evaluation.label, run.result.summary) +
            evaluation::states_text(run.states, console.look());
  }
  return text;
}

ExitCode run_drive(const RunOptions& options) {
  const Console console(options.common);
  const TypeRegistry registry =
      make_registry(options.common, drive::load_drive_config(options.input).plugins);
  check_choice(options.choice, registry);
  const LoadedDrive loaded = load_drive_for(options.input, options.overrides, registry, console);
  if (options.causal && loaded.config.outage.length_s == 0)
    throw UsageError("--causal: there are no outages to be predicted; name them with --outage LENGTH/EVERY");
  require_logs_stay(options, loaded);
  stop_if_interrupted();
  std::vector<drive::ModeledDrive> models = model_all(options, loaded, registry, console);
  formats::make_folder(options.folder);
  evaluation::ReportHeader header{loaded.config.name, {}};
  std::vector<ModelingRun> runs;
  ExitCode code = kSuccess;
  for (drive::ModeledDrive& modeled : models) {
    runs.push_back(run_modeling(options, loaded, std::move(modeled), registry, console, header));
    const ExitCode of_run = exit_code(runs.back().result.summary);
    if (of_run != kSuccess) code = of_run;
    if (interrupted) code = kInterrupted;
    if (code == kInterrupted) break;
  }
  std::vector<evaluation::LabelledEvaluation> evaluations;
  for (const ModelingRun& run : runs) evaluations.push_back(run.evaluation);
  const std::string metrics = evaluation::metrics_json(evaluations, header);
  const std::vector<std::string> common = write_common(runs, metrics, header, options.folder, console);
  if (options.common.json) {
    console.result(metrics);
    return code;
  }
  std::string text = describe_runs(loaded, runs, console);
  text += "\n" + evaluation::metrics_table(evaluations, console.look()) + "\nwritten:\n";
  for (const ModelingRun& run : runs) {
    for (const std::string& file : run.files) text += "  " + file + "\n";
  }
  for (const std::string& file : common) text += "  " + file + "\n";
  text += "  and the figures of the report as SVG and CSV in " + options.folder + "/figures\n";
  console.result(text);
  return code;
}

}  // namespace

void add_run(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "run",
      "The whole job: convert, optimise, evaluate\n\n"
      "Reads the logs that the drive.yaml names, makes the graph, optimises it and compares the result with "
      "truth and with the fixes that were kept out. The folder then holds graphs, trajectories and metrics, "
      "for each modeling.");
  const auto options = std::make_shared<RunOptions>();
  command->add_option("drive", options->input, "Description of the drive and its logs (drive.yaml)")
      ->required()
      ->type_name("DRIVE.yaml");
  command->add_option("-o,--out", options->folder, "Folder for all results")->required()->type_name("DIR");
  add_drive_options(*command, options->overrides);
  {
    const OptionHeading heading(*command, "The drive");
    command->add_flag("--causal", options->causal,
                      "Also predict each outage of --outage from what was known before its end");
  }
  add_optimization_options(*command, options->choice);
  add_common_options(*command, options->common);
  command->footer("Example:\n  waymark run drive.yaml --out results --modeling all");
  command->callback([options, &action] { action = [options] { return run_drive(*options); }; });
}

}  // namespace waymark::program
