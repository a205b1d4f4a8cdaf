/// The steps of the main job as the commands use them: drive.yaml to graph, document to evaluation, files
/// out.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <waymark/tools/drive/model/model.hpp>
#include <waymark/tools/drive/model/outages.hpp>
#include <waymark/tools/evaluation/evaluation.hpp>
#include <waymark/tools/evaluation/output/report.hpp>
#include <waymark/tools/program/terminal/console.hpp>

namespace waymark::program {

/// What the command line may override of a drive.yaml.
struct DriveOverrides {
  std::string data_folder;
  std::vector<std::string> modelings;  ///< empty: the drive.yaml's; "all": every registered one
  std::vector<std::string> modeling_options;
  std::optional<double> from_s;
  std::optional<double> to_s;
  std::optional<int> withhold_every;
  std::string outage;                  ///< "LENGTH/EVERY" in seconds; empty: none
  std::optional<std::string> start;    ///< anchored, dead_reckoning
  std::optional<std::string> loss;     ///< of the fixes, NAME:SCALE or "none"
  std::vector<std::string> calibrate;  ///< "on", "off", or NAME=MODEL pairs
  std::optional<std::string> noise;    ///< estimate, stated
  bool no_gate = false;
  bool sync = false;  ///< estimate how late the odometry is stamped, and apply it
};

/// A drive read; ready for any modeling.
struct LoadedDrive {
  drive::DriveConfig config;
  drive::PreparedDrive drive;
  std::vector<std::string> modelings;
  std::optional<Loss> loss;         ///< of the fixes
  std::vector<std::string> inputs;  ///< name and fingerprint of each log
  std::vector<std::string> files;   ///< that were read: drive.yaml and logs
};

/// Reads a drive.yaml and its logs; what was assumed or left out is told on the console.
[[nodiscard]] LoadedDrive load_drive_for(const std::string& path, const DriveOverrides& overrides,
                                         const TypeRegistry& registry, const Console& console);

/// The drive under one modeling, its graph with provenance; what is odd about it is told on the console.
[[nodiscard]] drive::ModeledDrive model_loaded(const LoadedDrive& loaded, const std::string& modeling,
                                               const Options& options, const TypeRegistry& registry,
                                               const Console& console);

/// The command line's modeling options that this modeling has; where several modelings run, each takes its
/// own.
[[nodiscard]] Options known_options(const std::string& modeling, const DriveOverrides& overrides,
                                    const TypeRegistry& registry);

/// Puts a document's provenance into a report, keys as "LABEL.KEY" (numbered where a key repeats).
void add_provenance(const formats::GraphDocument& document, const std::string& label,
                    evaluation::ReportHeader& header);

/// The way that the odometry says was driven, and its samples.
[[nodiscard]] std::string odometry_in_words(const LoadedDrive& loaded);

/// What of the logs did not go in, in words.
[[nodiscard]] std::string left_out(const LoadedDrive& loaded);

/// A paragraph on what went in: samples, fixes, what was left out.
[[nodiscard]] std::string describe_drive(const LoadedDrive& loaded);

/// Evaluates a document at its fixes. @param truth may be empty
/// @param further  predictions of its withheld fixes, beside the fused poses and dead reckoning
[[nodiscard]] evaluation::Evaluation evaluate_document(
    const formats::GraphDocument& document, const std::vector<TruthPose>& truth,
    const std::vector<evaluation::Prediction>& further = {});

[[nodiscard]] evaluation::Prediction as_prediction(std::string label, drive::PosesAtWithheld at);

/// Truth for a document from a drive.yaml or a TUM file, in the document's frame and on its clock.
[[nodiscard]] std::vector<TruthPose> read_truth(const std::string& path, const std::string& data_folder,
                                                const formats::GraphDocument& document,
                                                const TypeRegistry& registry);

/// Writes the trajectory of all poses as PREFIX.csv and PREFIX.tum and, where the frame is known, for maps as
/// PREFIX.geojson, PREFIX.kml and PREFIX.gpx; returns the names.
std::vector<std::string> write_trajectories(const formats::GraphDocument& document, const std::string& prefix,
                                            const std::string& name);

/// Writes what was found at every fix as PREFIX.epochs.csv; returns the name.
std::string write_epochs(const evaluation::Evaluation& evaluation, const std::string& prefix);

}  // namespace waymark::program
