#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/folder_lock.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/evaluation/output/summary_json.hpp>
#include <waymark/tools/program/commands/commands.hpp>
#include <waymark/tools/program/commands/drive_options.hpp>
#include <waymark/tools/program/jobs/drive_job.hpp>
#include <waymark/tools/program/jobs/drive_text.hpp>
#include <waymark/tools/program/jobs/evaluation/document_evaluation.hpp>
#include <waymark/tools/program/jobs/evaluation/hold_out.hpp>
#include <waymark/tools/program/jobs/evaluation/source_comparison.hpp>
#include <waymark/tools/program/jobs/graph/optimization.hpp>
#include <waymark/tools/program/jobs/live/window_study.hpp>
#include <waymark/tools/program/jobs/program_registry.hpp>
#include <waymark/tools/program/jobs/result_files.hpp>
#include <waymark/tools/program/jobs/result_warnings.hpp>
#include <waymark/tools/program/terminal/iteration_table.hpp>
#include <waymark/tools/program/terminal/output.hpp>

namespace waymark::program {
namespace {

struct RunOptions {
  CommonOptions common;
  DriveChoice choice;
  drive::Minimization minimization;
  std::string input;
  std::string folder;
  bool causal = false;
  std::vector<double> windows_s;  ///< of live runs to compare with
};

/// One modeling of the drive: graph, optimum, evaluation, files.
struct ModelingRun {
  evaluation::LabelledEvaluation evaluation;
  MultiStartSummary result;
  std::vector<evaluation::StateReport> states;
  drive::NoiseEstimate noise;
  std::string description;  ///< of the error model
  WrittenResult written;
  std::string windows;  ///< live runs beside this one, as text
};

/// The data that all modelings of a run share.
struct RunOfDrive {
  const RunOptions& options;
  const drive::DriveFile& file;
  const LoadedDrive& loaded;
  const evaluation::ResultFolder folder;
  const TypeRegistry& registry;
  const Console& console;
};

/// Warns if the minimisation for a causal prediction reached no minimum.
void judge_causal(const Summary& summary, const std::string& outage, formats::GraphDocument& document,
                  const Console& console) {
  for (const std::string& note : summary.notes) console.note(note);
  if (!summary.converged())
    warn("causal prediction for " + outage + ": " + no_minimum_warning(summary), document, console);
}

/// Predicts the withheld fixes with data up to the end of each outage only: the same settings on
/// the drive so far. Warnings go to the document of the whole drive.
evaluation::Prediction predict_causally(const RunOfDrive& run, drive::FusionSettings settings,
                                        formats::GraphDocument& document) {
  settings.minimization.covariances = "fixes";
  const auto runs = drive::withheld_runs(run.loaded.drive.fixes);
  const auto outages = std::count_if(runs.begin(), runs.end(), [](const auto& of) { return of.begin > 0; });
  StepProgress progress(run.console, static_cast<std::size_t>(outages));
  const drive::FuseDrive fuse =
      [&](const drive::PreparedDrive& known) -> std::optional<formats::GraphDocument> {
    if (interrupted) return std::nullopt;
    const std::string outage = fmt::format("the outage that ends at epoch {}", known.fixes.back().epoch);
    progress.next(
        fmt::format("{}: causal, outage {} of {}", settings.modeling, progress.step() + 1, outages));
    try {
      IterationTable iterations(run.console, progress.line());
      drive::FusedDrive fused =
          drive::fuse(known, settings, run.registry,
                      {.observer = [&](const IterationRecord& record) { iterations.add(record); },
                       .cancel = &interrupted});
      run.console.end_progress();
      if (fused.minimum.summary.termination == Termination::interrupted) return std::nullopt;
      judge_causal(fused.minimum.summary, outage, document, run.console);
      return std::move(fused.model.document);
    } catch (const InputError& error) {
      warn(fmt::format("no causal prediction for {}: {}", outage, error.what()), document, run.console);
      return std::nullopt;
    }
  };
  evaluation::Prediction causal = as_prediction("causal", drive::causal_at_withheld(run.loaded.drive, fuse));
  if (interrupted) warn("interrupted: some causal predictions are missing", document, run.console);
  return causal;
}

/// Evaluates a document with the covariances at its fixes, which it holds afterwards.
evaluation::Evaluation evaluate_minimum(const RunOfDrive& run, drive::ModeledDrive& modeled,
                                        const Summary& summary, const drive::FusionSettings& settings) {
  formats::GraphDocument& document = modeled.document;
  run.console.progress(settings.modeling + ": covariances");
  if (summary.converged() && document.covariances.empty()) {
    try {
      drive::add_covariances(document, "fixes");
    } catch (const InputError& error) {
      warn("stated errors cannot be judged: " + std::string(error.what()), document, run.console);
    }
  }
  std::vector<evaluation::Prediction> further;
  drive::PosesAtWithheld fixes = drive::with_lasting_errors(document, modeled.modelings);
  if (!fixes.poses.empty()) further.push_back(as_prediction("with lasting errors", std::move(fixes)));
  if (run.options.causal) further.push_back(predict_causally(run, settings, document));
  evaluation::Evaluation evaluation = evaluate_document(document, run.loaded.drive.truth, further);
  run.console.end_progress();
  if (summary.converged())
    evaluation.sources = compare_sources(run.loaded.drive, modeled, evaluation, run.registry, run.console);
  if (summary.converged())
    evaluation.held_out = hold_out(run.loaded.drive, modeled, run.registry, run.console);
  return evaluation;
}

ModelingRun run_modeling(const RunOfDrive& run, drive::ModeledDrive modeled,
                         const drive::FusionSettings& settings, evaluation::ReportHeader& header) {
  const std::string& modeling = settings.modeling;
  const Console& console = run.console;
  ModelingRun result;
  const drive::FusionSettings fused = modeled.settings;
  result.noise = modeled.noise;
  result.description = describe_model(modeled, console.look());
  formats::GraphDocument& document = modeled.document;
  const auto write = [&](const std::string& name) {
    formats::write_file_atomically(
        name, [&](const formats::TextSink& sink) { formats::write_graph(document, run.registry, sink); });
  };
  write(run.folder.graph(modeling));
  console.detail("optimising " + modeling);
  result.result = optimize_document(document, settings.minimization, run.registry, console, {}, modeling);
  const Summary& summary = result.result.summary;
  record_optimization(result.result, document);
  write(run.folder.fused_graph(modeling));  // the minimum is saved before anything else can fail
  const std::size_t known = document.provenance.size();
  result.states = states_of_minimum(document, summary, console);
  const std::vector<formats::VertexCovariance> asked_for = document.covariances;
  result.evaluation = {modeling, evaluate_minimum(run, modeled, summary, settings)};
  // The graph file has the covariances that were asked for, the trajectory all that are known.
  std::vector<formats::VertexCovariance> known_covariances = std::exchange(document.covariances, asked_for);
  for (const std::string& sentence :
       warnings_of_result(result.states, modeled.settings, result.noise, result.evaluation.evaluation))
    warn(run.loaded.settings.size() > 1 ? modeling + ": " + sentence : sentence, document, console);
  std::optional<evaluation::Sparsity> sparsity = sparsity_for_report(document, console);
  if (document.provenance.size() > known) write(run.folder.fused_graph(modeling));
  add_provenance(document, modeling, header);
  std::vector<drawing::Section> more_sections;
  if (!run.options.windows_s.empty() && !interrupted) {
    const auto& truth = result.evaluation.evaluation.truth;
    WindowStudy study =
        study_windows({run.file, fused, run.loaded.drive, run.options.windows_s, run.options.folder,
                       truth ? truth->fused.position.rmse_m : std::nan("")},
                      run.registry, console);
    result.windows = study.text + "\n";
    more_sections.push_back(std::move(study.section));
  }
  document.covariances.swap(known_covariances);
  result.written =
      write_result({.drive = header.drive,
                    .document = document,
                    .evaluated = result.evaluation,
                    .truth = run.loaded.drive.truth,
                    .optimization = &result.result,
                    .states = result.states,
                    .sparsity = std::move(sparsity),
                    .noise = result.noise.parameters.empty() ? text::Table() : noise_table(result.noise),
                    .went_in = {{"odometry", odometry_in_words(run.loaded.drive)},
                                {"left out", left_out(run.loaded.drive)}},
                    .files = {run.folder.graph(modeling), run.folder.fused_graph(modeling)},
                    .more_sections = std::move(more_sections)},
                   run.folder, run.loaded.settings.size(), console);
  document.covariances.swap(known_covariances);
  return result;
}

std::string run_line(const std::string& modeling, const Summary& s) {
  return fmt::format("{:<11} {} in {} iterations, {:.3f} s, chi2 {:.10g} -> {:.10g}{}\n", modeling,
                     s.converged() ? "converged" : "NOT CONVERGED", s.iterations, s.total_seconds,
                     s.initial_chi2, s.final_chi2, s.converged() ? "" : " (" + s.message + ")");
}

void require_logs_stay(const RunOfDrive& run) {
  std::vector<std::string> modelings;
  for (const drive::FusionSettings& settings : run.loaded.settings) modelings.push_back(settings.modeling);
  for (const std::string& file : run.folder.files(modelings)) require_not_read(file, run.loaded.files);
}

/// Returns the modelings of a drive. Errors in one of them are found before anything is written.
std::vector<drive::ModeledDrive> model_all(const RunOfDrive& run) {
  drive::Fusion fusion(run.loaded.drive, run.registry);
  std::set<std::string> told;
  std::vector<drive::ModeledDrive> models;
  for (const drive::FusionSettings& settings : run.loaded.settings) {
    models.push_back(model_loaded(fusion, settings, run.registry, run.console, told));
    stop_if_interrupted();
  }
  return models;
}

/// Writes the files that all modelings share: the comparison, metrics.json, summary.json. Returns
/// their names.
std::vector<std::string> write_common(const RunOfDrive& run, const std::vector<ModelingRun>& runs,
                                      const std::string& metrics, const evaluation::ReportHeader& header) {
  std::vector<ComparedResult> results;
  std::vector<nlohmann::ordered_json> noise;
  for (const ModelingRun& of : runs) {
    results.push_back({of.evaluation, &of.result});
    noise.push_back(noise_json(of.noise));
  }
  std::vector<std::string> files = write_overview(results, header, metrics, run.folder, run.console);
  std::vector<evaluation::RunSummary> summaries;
  for (std::size_t i = 0; i < runs.size(); ++i)
    summaries.push_back({runs[i].evaluation.label, runs[i].result, runs[i].states, noise[i]});
  files.push_back(run.folder.summary());
  formats::write_file_atomically(files.back(), json_text(evaluation::run_summary_json(summaries)));
  return files;
}

std::string describe_runs(const RunOfDrive& run, const std::vector<ModelingRun>& runs) {
  std::string text = describe_drive(run.loaded.drive);
  std::vector<std::string> described;
  for (const ModelingRun& of : runs) {
    const bool known = std::any_of(described.begin(), described.end(), [&](const std::string& earlier) {
      return earlier.starts_with(of.description);
    });
    if (!known) text += described.emplace_back(of.description);
    text += run_line(of.evaluation.label, of.result.summary) +
            evaluation::states_text(of.states, run.console.look());
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
std::string run_text(const RunOfDrive& run, const std::vector<ModelingRun>& runs,
                     const std::vector<evaluation::LabelledEvaluation>& evaluations,
                     const std::vector<std::string>& common) {
  const std::string page = run.folder.page(run.folder.kReport);
  std::string text = describe_runs(run, runs) + "\n" +
                     evaluation::metrics_table(evaluations, run.console.look()) + "\nwritten:\n  " + page +
                     "\n";
  for (const ModelingRun& of : runs) {
    if (of.written.page != page) text += "  " + of.written.page + "\n";
    for (const std::string& file : of.written.files) text += "  " + file + "\n";
  }
  for (const std::string& file : common)
    if (file != page) text += "  " + file + "\n";
  return text + "  and the figures of the report as SVG and CSV in " + run.folder.figures() + "\n" +
         verdicts(runs, page);
}

ExitCode run_drive(const RunOptions& options) {
  const Console console(options.common);
  drive::DriveFile file = read_drive_file(options.input, options.choice);
  file.settings.minimization = options.minimization;
  const TypeRegistry registry = make_registry(options.common, file.description.plugins);
  drive::check_minimization(options.minimization, registry);
  const LoadedDrive loaded = load_drive_for(file, options.choice, registry, console);
  if (!options.windows_s.empty() && loaded.drive.truth.empty())
    throw UsageError("--window: the drive has no truth to compare with");
  if (options.causal && file.description.outage.length_s == 0)
    throw UsageError("--causal: there are no outages to predict; name them with --outage LENGTH/EVERY");
  const RunOfDrive run{options, file, loaded, evaluation::ResultFolder(options.folder), registry, console};
  require_logs_stay(run);
  stop_if_interrupted();
  std::vector<drive::ModeledDrive> models = model_all(run);
  formats::make_folder(options.folder);
  const formats::FolderLock lock(options.folder);
  evaluation::ReportHeader header{loaded.drive.name, {}};
  std::vector<ModelingRun> runs;
  std::vector<evaluation::LabelledEvaluation> evaluations;
  ExitCode code = kSuccess;
  std::string windows;
  for (std::size_t i = 0; i < models.size() && code != kInterrupted; ++i) {
    runs.push_back(run_modeling(run, std::move(models[i]), loaded.settings[i], header));
    evaluations.push_back(runs.back().evaluation);
    const ExitCode of_run = exit_code(runs.back().result.summary);
    if (of_run != kSuccess) code = of_run;
    if (interrupted) code = kInterrupted;
    windows += runs.back().windows;
  }
  const std::string metrics = evaluation::metrics_json(evaluations, header);
  const std::vector<std::string> common = write_common(run, runs, metrics, header);
  console.result(options.common.json ? metrics : windows + run_text(run, runs, evaluations, common));
  return code;
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
  command->add_option("-o,--out", options->folder, "Folder for all results")->required()->type_name("DIR");
  add_drive_options(*command, options->choice);
  {
    const OptionHeading heading(*command, "The drive");
    command->add_flag("--causal", options->causal, "Also predict each outage of --outage without later data");
    command
        ->add_option("--window", options->windows_s,
                     "Also fuse as 'live' does, in windows of so many seconds: 1,5,15,60,300")
        ->type_name("SECONDS[,...]")
        ->delimiter(',')
        ->check(CLI::Range(1.0, 1e5));
  }
  add_optimization_options(*command, options->minimization);
  add_common_options(*command, options->common);
  command->footer("Example:\n  waymark run drive.yaml --out results --modeling all");
  command->callback([options, &action] { action = [options] { return run_drive(*options); }; });
}

}  // namespace waymark::program
