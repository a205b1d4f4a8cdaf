/// The whole main job on one drive: logs, graph, minimum, evaluation, files. `waymark run` and the
/// Python package are both this function and the way in which they show its result.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <waymark/core/optimize/multi_start.hpp>
#include <waymark/tools/drive/model/fuse.hpp>
#include <waymark/tools/evaluation/document/estimated_states.hpp>
#include <waymark/tools/evaluation/evaluation.hpp>
#include <waymark/tools/evaluation/output/report.hpp>
#include <waymark/tools/program/jobs/drive/drive_job.hpp>
#include <waymark/tools/program/jobs/result_files.hpp>
#include <waymark/tools/program/terminal/console.hpp>

namespace waymark::program {

/// What is done with a drive, beside what its drive.yaml and the choices say.
struct DriveRunOptions {
  std::optional<std::string> folder{};  ///< for all results; empty: nothing is written
  std::string map{};                    ///< beneath the trajectory of the report; empty: none
  bool causal = false;                  ///< predict each outage without later data, too
  std::vector<double> windows_s{};      ///< of live runs to compare with; they need a folder
  bool keeps_models = false;            ///< ModelingRun::model is filled
};

/// One modeling of the drive: graph, optimum, evaluation, files.
struct ModelingRun {
  evaluation::LabelledEvaluation evaluation;
  MultiStartSummary result;
  std::vector<evaluation::StateReport> states;
  drive::NoiseEstimate noise;
  std::vector<std::string> without_delay;  ///< drive::ModeledDrive::without_delay
  std::string description;                 ///< of the error model
  WrittenResult written;
  std::string windows;  ///< live runs beside this one, as text
  /// At its minimum, with all covariances that are known: those that were asked for, and those at
  /// the fixes, which the evaluation needs.
  std::optional<drive::ModeledDrive> model;
};

/// A drive after the main job.
struct DriveRun {
  LoadedDrive loaded;
  std::vector<ModelingRun> modelings;  ///< fewer than were asked for if the run was interrupted
  std::vector<evaluation::LabelledEvaluation> evaluations;  ///< of the modelings
  std::string metrics;                                      ///< content of metrics.json
  /// that all modelings share: comparison, metrics.json, summary.json; paths
  std::vector<std::string> common_files;
};

/// Runs the main job. A minimum that is not reached is no error: MultiStartSummary says so.
/// @param file its settings.minimization says how the graphs are minimised
/// @throws errors of the steps; Interrupted if there was no result yet; UsageError for options that
/// the drive cannot serve
[[nodiscard]] DriveRun run_drive(const drive::DriveFile& file, const DriveChoice& choice,
                                 const DriveRunOptions& options, const TypeRegistry& registry,
                                 const Console& console);

}  // namespace waymark::program
