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

/// What settings are run with.
struct Laboratory {
  const TypeRegistry& registry;
  /// How a fused document is judged. @param converged whether the document is at a minimum
  std::function<evaluation::Evaluation(formats::GraphDocument& document, const std::vector<TruthPose>& truth,
                                       bool converged)>
      evaluate;
  /// Told before every run what comes; may throw to end all of it.
  std::function<void(const std::string&)> progress;
  const std::atomic<bool>* cancel = nullptr;  ///< as OptimizerOptions::cancel
};

/// The largest differences between the vehicle's poses of two results.
struct PoseDifference {
  double position_m = evaluation::kUndefined;
  double heading_rad = evaluation::kUndefined;
};

/// One setting on one drive.
struct Outcome {
  Setting setting;
  std::string failure;  ///< why there is no result; empty: there is one
  Ending ending;
  std::size_t accepted = 0;  ///< fixes
  std::size_t rejected = 0;
  drive::NoiseEstimate noise;  ///< no parameters where it is as stated
  evaluation::Evaluation
      evaluation;  ///< without its lists of epochs; nothing where the setting is not evaluated
  /// From the lowest minimum that was found for the setting's objective (compare_outcomes); undefined without
  /// objective.
  PoseDifference from_minimum;
  double minimum_chi2 = evaluation::kUndefined;
  std::vector<Eigen::Vector3d> poses;  ///< of the vehicle, by time; dropped by compare_outcomes

  [[nodiscard]] double rejected_percent() const;
};

/// A drive with everything that its settings share.
class StudiedDrive {
 public:
  /// @param description  of a drive.yaml, without further sensors: the settings say what is done, the same for
  ///                     every drive
  /// @param logs         of it
  /// @param registry     must outlive the object
  StudiedDrive(drive::DriveDescription description, const drive::DriveLogs& logs,
               const TypeRegistry& registry);
  StudiedDrive(const StudiedDrive&) = delete;
  StudiedDrive& operator=(const StudiedDrive&) = delete;

  [[nodiscard]] const drive::DriveDescription& description() const { return description_; }
  [[nodiscard]] const drive::PreparedDrive& drive() const { return drive_; }
  /// The graph of a setting at its initial guess. @throws what Fusion::model throws
  [[nodiscard]] drive::ModeledDrive model(const Setting& setting) { return fusion_.model(setting.fusion); }

 private:
  drive::DriveDescription description_;
  drive::PreparedDrive drive_;
  drive::Fusion fusion_;  // of drive_
};

/// Fuses the drive as the setting says. What a drive does not allow (all fixes rejected, a lever arm with the
/// literal error) is the outcome's failure.
[[nodiscard]] Outcome run_setting(StudiedDrive& drive, const Setting& setting, const Laboratory& laboratory);

/// Runs all of them and compares their ends.
[[nodiscard]] std::vector<Outcome> run_settings(StudiedDrive& drive, const std::vector<Setting>& settings,
                                                const Laboratory& laboratory);

/// Fills from_minimum and minimum_chi2 of all outcomes: the lowest chi2 of each objective is its minimum.
void compare_outcomes(std::vector<Outcome>& outcomes);

/// Runs with our settings ended at the same minimum where no pose differs by more: 1 cm, 0.1 degrees.
inline constexpr PoseDifference kSamePoses = {0.01, 0.1 * 0.017453292519943295};
[[nodiscard]] bool at_minimum(const Outcome& outcome);
/// A run with the paper's settings reached its minimum where chi2 is less than 1 above it: no pose is then
/// further from it than one of its standard deviations. A length would not do: these runs stop early by
/// design, and their weights leave some poses free by metres.
inline constexpr double kReachedChi2 = 1;
[[nodiscard]] bool near_minimum(const Outcome& outcome);

/// @return null where there is none of this name
[[nodiscard]] const Outcome* find_outcome(const std::vector<Outcome>& outcomes, const std::string& name);

}  // namespace waymark::reproduction
