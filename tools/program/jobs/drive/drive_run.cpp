#include <waymark/tools/program/jobs/drive/drive_run.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/folder_lock.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/drive/estimation/noise_spread.hpp>
#include <waymark/tools/evaluation/output/summary_json.hpp>
#include <waymark/tools/program/jobs/drive/drive_text.hpp>
#include <waymark/tools/program/jobs/evaluation/document_evaluation.hpp>
#include <waymark/tools/program/jobs/evaluation/hold_out.hpp>
#include <waymark/tools/program/jobs/evaluation/lasting_innovations.hpp>
#include <waymark/tools/program/jobs/evaluation/map_file.hpp>
#include <waymark/tools/program/jobs/evaluation/source_comparison.hpp>
#include <waymark/tools/program/jobs/graph/optimization.hpp>
#include <waymark/tools/program/jobs/live/window_study.hpp>
#include <waymark/tools/program/jobs/result_warnings.hpp>
#include <waymark/tools/program/terminal/iteration_table.hpp>
#include <waymark/tools/program/terminal/output.hpp>

namespace waymark::program {
namespace {

/// The data that all modelings of a run share.
struct RunOfDrive {
  const DriveRunOptions& options;
  const drive::DriveFile& file;
  const LoadedDrive& loaded;
  const MapFile& map;
  const evaluation::ResultFolder folder;
  const TypeRegistry& registry;
  const Console& console;

  [[nodiscard]] bool writes() const { return options.folder.has_value(); }
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
    if (run.console.cancel()) return std::nullopt;
    const std::string outage = fmt::format("the outage that ends at epoch {}", known.fixes.back().epoch);
    progress.next(
        fmt::format("{}: causal, outage {} of {}", settings.modeling, progress.step() + 1, outages));
    try {
      IterationTable iterations(run.console, progress.line());
      drive::FusedDrive fused =
          drive::fuse(known, settings, run.registry,
                      {.observer = [&](const IterationRecord& record) { iterations.add(record); },
                       .cancel = &run.console.cancel()});
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
  if (run.console.cancel()) warn("interrupted: some causal predictions are missing", document, run.console);
  return causal;
}

/// Gives a drive the covariances of all its vertices.
void add_all_covariances(const RunOfDrive& run, const drive::FusionSettings& settings,
                         drive::ModeledDrive& modeled) {
  run.console.progress(settings.modeling + ": covariances");
  try {
    if (settings.minimization.covariances == "all")  // those of the graph are there
      drive::widen(modeled.document.covariances, modeled.document.graph, modeled.noise.spread);
    else
      drive::add_covariances(modeled, "all");
  } catch (const InputError& error) {
    warn("stated errors cannot be judged: " + std::string(error.what()), modeled.document, run.console);
  }
  run.console.end_progress();
}

/// Evaluates a document with the covariances that it has.
evaluation::Evaluation evaluate_minimum(const RunOfDrive& run, drive::ModeledDrive& modeled,
                                        const Summary& summary, const drive::FusionSettings& settings) {
  formats::GraphDocument& document = modeled.document;
  std::vector<evaluation::Prediction> further;
  drive::PosesAtWithheld fixes = drive::with_lasting_errors(document, modeled.modelings);
  if (!fixes.poses.empty()) further.push_back(as_prediction("with lasting errors", std::move(fixes)));
  if (run.options.causal) further.push_back(predict_causally(run, settings, document));
  evaluation::Evaluation evaluation = evaluate_document(document, run.loaded.drive.truth, further);
  evaluation.groups = evaluation::residuals_by_group(document.graph, modeled.groups);
  // The single measurements are as many as the readings; the report computes them again.
  for (evaluation::GroupedResiduals& of : evaluation.groups) of.measurements = {};
  if (!document.covariances.empty() && evaluation.prediction.count == 0) {
    if (const auto lasting = lasting_innovations(document, modeled.modelings))
      evaluation.prediction = lasting->statistics;
  }
  if (!summary.converged()) return evaluation;
  // What is fused again for a comparison has the same readings.
  const drive::PreparedDrive& drive = modeled.other_readings ? *modeled.other_readings : run.loaded.drive;
  evaluation.sources = compare_sources(drive, modeled, evaluation, run.registry, run.console);
  evaluation.held_out = hold_out(drive, modeled, run.registry, run.console);
  return evaluation;
}

/// The files of one modeling. Without a folder nothing is written.
class ModelingFiles {
 public:
  ModelingFiles(const RunOfDrive& run, const formats::GraphDocument& document, const std::string& modeling)
      : run_(run), document_(document), modeling_(modeling) {}

  void write_graph() const { write(run_.folder.graph(modeling_)); }
  void write_fused_graph() const { write(run_.folder.fused_graph(modeling_)); }

 private:
  void write(const std::string& name) const {
    if (!run_.writes()) return;
    formats::write_file_atomically(
        name, [&](const formats::TextSink& sink) { formats::write_graph(document_, run_.registry, sink); });
  }

  const RunOfDrive& run_;
  const formats::GraphDocument& document_;
  const std::string& modeling_;
};

/// Compares with live runs, if that was asked for. Returns the sections of the report about them.
std::vector<drawing::Section> compare_windows(const RunOfDrive& run, const drive::FusionSettings& settings,
                                              ModelingRun& result) {
  if (run.options.windows_s.empty() || run.console.cancel()) return {};
  const auto& truth = result.evaluation.evaluation.truth;
  WindowStudy study =
      study_windows({run.file, settings, run.loaded.drive, run.options.windows_s, *run.options.folder,
                     truth ? truth->fused.position.rmse_m : std::nan("")},
                    run.registry, run.console);
  result.windows = study.text + "\n";
  return {std::move(study.section)};
}

/// Writes trajectories, epochs and report of a document with all known covariances.
void write_modeling(const RunOfDrive& run, const drive::ModeledDrive& modeled, const std::string& drive,
                    std::optional<evaluation::Sparsity> sparsity, std::vector<drawing::Section> more_sections,
                    ModelingRun& result) {
  const std::string& modeling = result.evaluation.label;
  result.written =
      write_result({.drive = drive,
                    .document = modeled.document,
                    .evaluated = result.evaluation,
                    .truth = run.loaded.drive.truth,
                    .optimization = &result.result,
                    .states = result.states,
                    .sparsity = std::move(sparsity),
                    .noise = result.noise.parameters.empty() ? text::Table() : noise_table(result.noise),
                    .went_in = {{"odometry", odometry_in_words(run.loaded.drive)},
                                {"left out", left_out(run.loaded.drive)}},
                    .files = {run.folder.graph(modeling), run.folder.fused_graph(modeling)},
                    .map = &run.map,
                    .groups = modeled.groups,
                    .more_sections = std::move(more_sections)},
                   run.folder, run.loaded.settings.size(), run.console);
}

/// Optimises a modeled drive, and evaluates its minimum. Afterwards the document has the covariances that
/// were asked for, of the graph as it is. @return all that are known, with what is not known of the noise
std::vector<formats::VertexCovariance> minimise_and_judge(const RunOfDrive& run, drive::ModeledDrive& modeled,
                                                          const drive::FusionSettings& settings,
                                                          const ModelingFiles& files, ModelingRun& result) {
  const std::string& modeling = settings.modeling;
  const Console& console = run.console;
  formats::GraphDocument& document = modeled.document;
  files.write_graph();
  console.detail("optimising " + modeling);
  result.result = at_drive(run.loaded, [&] {
    return optimize_document(document, settings.minimization, run.registry, console, {}, modeling);
  });
  const Summary& summary = result.result.summary;
  record_optimization(result.result, document);
  files.write_fused_graph();  // the minimum is saved before anything else can fail
  std::vector<formats::VertexCovariance> asked_for = document.covariances;
  if (summary.converged()) add_all_covariances(run, settings, modeled);
  result.states = states_of_minimum(document, summary, console);
  result.evaluation = {modeling, evaluate_minimum(run, modeled, summary, settings)};
  std::vector<formats::VertexCovariance> known = std::exchange(document.covariances, std::move(asked_for));
  for (const std::string& sentence :
       warnings_of_result(result.states, modeled.settings, result.noise, result.evaluation.evaluation))
    warn(run.loaded.settings.size() > 1 ? modeling + ": " + sentence : sentence, document, console);
  return known;
}

ModelingRun run_modeling(const RunOfDrive& run, drive::ModeledDrive modeled,
                         const drive::FusionSettings& settings, evaluation::ReportHeader& header) {
  ModelingRun result;
  result.noise = modeled.noise;
  result.without_delay = modeled.without_delay;
  result.description = describe_model(modeled, run.console.look());
  formats::GraphDocument& document = modeled.document;
  const ModelingFiles files(run, document, settings.modeling);
  const std::size_t before = document.provenance.size();
  std::vector<formats::VertexCovariance> covariances =
      minimise_and_judge(run, modeled, settings, files, result);
  std::optional<evaluation::Sparsity> sparsity;
  if (run.writes()) sparsity = sparsity_for_report(document, run.console);
  // The record of the optimisation is one entry, or two if it has reached no minimum.
  const std::size_t recorded = result.result.summary.converged() ? 1 : 2;
  if (document.provenance.size() > before + recorded) files.write_fused_graph();
  add_provenance(document, settings.modeling, header);
  std::vector<drawing::Section> more_sections = compare_windows(run, settings, result);
  // The graph file has the covariances that were asked for, the trajectory all that are known.
  document.covariances.swap(covariances);
  if (run.writes())
    write_modeling(run, modeled, header.drive, std::move(sparsity), std::move(more_sections), result);
  if (run.options.keeps_models) result.model = std::move(modeled);
  return result;
}

void require_logs_stay(const RunOfDrive& run) {
  std::vector<std::string> modelings;
  for (const drive::FusionSettings& settings : run.loaded.settings) modelings.push_back(settings.modeling);
  for (const std::string& file : run.folder.files(modelings)) require_not_read(file, run.loaded.files);
}

/// Returns the modelings of a drive. Errors in one of them are found before anything is written.
std::vector<drive::ModeledDrive> model_all(const RunOfDrive& run) {
  drive::Fusion fusion(run.loaded.drive, run.registry, [&] { run.console.stop_if_cancelled(); });
  std::set<std::string> told;
  std::vector<drive::ModeledDrive> models;
  for (const drive::FusionSettings& settings : run.loaded.settings) {
    models.push_back(at_drive(
        run.loaded, [&] { return model_loaded(fusion, settings, run.registry, run.console, told); }));
    run.console.stop_if_cancelled();
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
    summaries.push_back(
        {runs[i].evaluation.label, runs[i].result, runs[i].states, noise[i], runs[i].without_delay});
  files.push_back(run.folder.summary());
  formats::write_file_atomically(files.back(), json_text(evaluation::run_summary_json(summaries)));
  return files;
}

}  // namespace

DriveRun run_drive(const drive::DriveFile& file, const DriveChoice& choice, const DriveRunOptions& options,
                   const TypeRegistry& registry, const Console& console) {
  drive::check_minimization(file.settings.minimization, registry);
  DriveRun done{load_drive_for(file, choice, registry, console), {}, {}, {}, {}};
  if (!options.windows_s.empty() && done.loaded.drive.truth.empty())
    throw UsageError("--window: the drive has no truth to compare with");
  if (options.causal && file.description.outage.length_s == 0)
    throw UsageError("--causal: there are no outages to predict; name them with --outage LENGTH/EVERY");
  if (!options.map.empty()) done.loaded.files.push_back(options.map);
  const drive::PreparedDrive& drive = done.loaded.drive;
  // A wrong map is found before the work, if the drive has fixes that say where it is.
  const bool has_fixes = !drive.fixes.empty();
  MapFile map;
  if (has_fixes) map = read_map_file(options.map, drive.frame, positions_of(drive.fixes));
  const RunOfDrive run{
      options,  file,   done.loaded, map, evaluation::ResultFolder(options.folder.value_or("")),
      registry, console};
  if (run.writes()) require_logs_stay(run);
  console.stop_if_cancelled();
  std::vector<drive::ModeledDrive> models = model_all(run);
  if (!has_fixes) map = read_map_file(options.map, drive.frame, positions_of(models.front().document));
  std::optional<formats::FolderLock> lock;
  if (run.writes()) {
    formats::make_folder(*options.folder);
    lock.emplace(*options.folder);
  }
  evaluation::ReportHeader header{done.loaded.drive.name, {}};
  for (std::size_t i = 0; i < models.size() && (i == 0 || !console.cancel()); ++i) {
    done.modelings.push_back(run_modeling(run, std::move(models[i]), done.loaded.settings[i], header));
    done.evaluations.push_back(done.modelings.back().evaluation);
  }
  done.metrics = evaluation::metrics_json(done.evaluations, header);
  if (run.writes()) done.common_files = write_common(run, done.modelings, done.metrics, header);
  return done;
}

}  // namespace waymark::program
