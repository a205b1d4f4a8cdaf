/// Runs settings on a drive that was read once.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/model/fuse.hpp>
#include <waymark/tools/evaluation/evaluation.hpp>
#include <waymark/tools/reproduction/experiment/minimization.hpp>
#include <waymark/tools/reproduction/experiment/setting.hpp>

namespace waymark::reproduction {

/// The equipment that all runs of settings share.
struct Laboratory {
  const TypeRegistry& registry;
  /// Evaluates a fused drive. @param converged whether its document is at a minimum
  std::function<evaluation::Evaluation(drive::ModeledDrive& fused, const std::vector<TruthPose>& truth,
                                       bool converged)>
      evaluate;
  /// Called before every run with its description. It may throw to end all runs.
  std::function<void(const std::string&)> progress;
  const std::atomic<bool>* cancel = nullptr;  ///< as OptimizerOptions::cancel
};

/// The largest differences between the vehicle poses of two results.
struct PoseDifference {
  double position_m = evaluation::kUndefined;
  double heading_rad = evaluation::kUndefined;
};

/// One setting on one drive.
struct Outcome {
  Setting setting;
  std::string failure;  ///< why there is no result; empty: there is one
  Ending ending;
  std::size_t accepted = 0;  ///< accepted fixes
  std::size_t rejected = 0;
  drive::NoiseEstimate noise;  ///< without parameters if the noise is as stated; without its spread
  /// without its lists of epochs; empty if the setting is not evaluated
  evaluation::Evaluation evaluation;
  /// Distance from the lowest minimum found for the objective of the setting (compare_outcomes).
  /// Undefined without an objective.
  PoseDifference from_minimum;
  double minimum_chi2 = evaluation::kUndefined;
  std::vector<Eigen::Vector3d> poses;  ///< of the vehicle, by time; compare_outcomes removes them

  [[nodiscard]] double rejected_percent() const;
};

/// A drive with everything that its settings share.
class StudiedDrive {
 public:
  /// @param description from a drive.yaml, without further sensors: the settings define the rest,
  /// the same for every drive
  /// @param logs logs of the drive
  /// @param registry must outlive the object
  StudiedDrive(drive::DriveDescription description, const drive::DriveLogs& logs,
               const TypeRegistry& registry);
  StudiedDrive(const StudiedDrive&) = delete;
  StudiedDrive& operator=(const StudiedDrive&) = delete;

  [[nodiscard]] const drive::DriveDescription& description() const { return description_; }
  [[nodiscard]] const drive::PreparedDrive& drive() const { return drive_; }
  /// Returns the graph of a setting at its initial guess. @throws what Fusion::model throws
  [[nodiscard]] drive::ModeledDrive model(const Setting& setting) { return fusion_.model(setting.fusion); }

 private:
  drive::DriveDescription description_;
  drive::PreparedDrive drive_;
  drive::Fusion fusion_;  // of drive_
};

/// Fuses the drive with a setting. If the drive does not allow it (all fixes rejected, a lever arm
/// with the literal error), the outcome has a failure.
[[nodiscard]] Outcome run_setting(StudiedDrive& drive, const Setting& setting, const Laboratory& laboratory);

/// Runs all settings and compares their ends.
[[nodiscard]] std::vector<Outcome> run_settings(StudiedDrive& drive, const std::vector<Setting>& settings,
                                                const Laboratory& laboratory);

/// Fills from_minimum and minimum_chi2 of all outcomes. The lowest chi2 of each objective is
/// its minimum.
void compare_outcomes(std::vector<Outcome>& outcomes);

/// Two runs with our settings ended at the same minimum if no pose differs by more: 1 cm,
/// 0.1 degrees.
inline constexpr PoseDifference kSamePoses = {0.01, 0.1 * 0.017453292519943295};
[[nodiscard]] bool at_minimum(const Outcome& outcome);
/// A run with the settings of the paper reached its minimum if chi2 is less than this above it. No
/// pose is then further from the minimum than one of its standard deviations. A length would not
/// work: these runs stop early by design, and their weights leave some poses free by metres.
inline constexpr double kReachedChi2 = 1;
[[nodiscard]] bool near_minimum(const Outcome& outcome);

/// @return null if there is none with this name
[[nodiscard]] const Outcome* find_outcome(const std::vector<Outcome>& outcomes, const std::string& name);

}  // namespace waymark::reproduction
