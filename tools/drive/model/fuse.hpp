/// The main job as a component. It turns a drive in memory (load_drive) into a graph, and finds
/// its minimum.
///
///   const DriveFile file = load_drive_file("drive.yaml");
///   const PreparedDrive drive = load_drive(file.description, registry);
///   const FusedDrive fused = fuse(drive, file.settings, registry);
///   for (const StampedPose& pose : poses_at_fixes(fused.model.document)) ...
///
/// The steps are:
/// 1. decided() completes the settings with the defaults of the modeling.
/// 2. place_drive() judges the fixes and computes the initial guess.
/// 3. estimate_noise() estimates the noise parameters.
/// 4. build_graph() builds the graph.
/// 5. minimize() finds its minimum.
///
/// `waymark run`, `convert`, causal predictions and the experiments all use these steps.
///
/// Ownership: results are values and contain no references. Threads: the functions keep no state.
/// Calls for different drives may run at the same time, also with one registry. A Fusion may only
/// be used by one thread at a time. Errors: UsageError for settings with names that the registry
/// does not have, InputError for a drive that cannot be fused. If the minimum is not reached, this
/// is no error; MultiStartSummary::summary.termination reports it.
#pragma once

#include <functional>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <waymark/core/optimize/multi_start.hpp>
#include <waymark/core/registry/registry.hpp>
#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/drive/estimation/noise.hpp>
#include <waymark/tools/drive/estimation/speed_slip.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>
#include <waymark/tools/drive/model/minimize.hpp>
#include <waymark/tools/drive/model/place.hpp>
#include <waymark/tools/drive/trials/antenna_place.hpp>
#include <waymark/tools/drive/trials/clock_drift.hpp>

namespace waymark::drive {

/// A drive with one error model, at its initial guess.
struct ModeledDrive {
  FusionSettings settings;   ///< from decided(), with the estimated noise among the options
  FusionSettings decision;   ///< the same without the estimated noise
  PlacedDrive placed;        ///< nodes, gate, initial guess
  NoiseEstimate noise;       ///< without parameters if the noise is as stated
  ClockDrift clock_drift{};  ///< of which the odometry was freed
  SpeedSlip slip{};          ///< that its speeds seem to have
  /// the drive with the readings that were fused, if they are others than those that were read: moved in time, freed
  /// of a slip. What fuses the same drive again with these settings takes it
  std::shared_ptr<const PreparedDrive> other_readings{};
  std::vector<std::string> sensor_warnings;
  /// groups of receivers whose fixes are taken as not late; an only receiver is ""
  std::vector<std::string> without_delay;
  std::vector<std::string> notes;     ///< sentences about what the drive decided
  double distance_m = 0;              ///< by the odometry
  formats::GraphDocument document{};  ///< with provenance: provenance.hpp
  /// that built the graph of the document: one for each absolute source
  std::vector<std::shared_ptr<const GnssModeling>> modelings{};
  std::vector<GroupsOfSource> groups{};  ///< of the measurements in the graph of the document

  /// Returns sentences about suspicious facts in the logs.
  [[nodiscard]] std::vector<std::string> warnings() const;
};

/// A drive with one error model, at its minimum.
struct FusedDrive {
  /// the document holds the best values, and the requested covariances
  ModeledDrive model;
  MultiStartSummary minimum;  ///< how it was found
};

/// Fuses a drive.
/// @param drive from load_drive or prepare_drive; its sensors are used
/// @throws errors of the steps
[[nodiscard]] FusedDrive fuse(const PreparedDrive& drive, const FusionSettings& settings,
                              const TypeRegistry& registry, const MinimizationWatch& watch = {});

/// Fuses one drive in several ways. Ways with the same gate and initial guess share these, and all
/// share the nodes in time.
class Fusion {
 public:
  /// Drive and registry must outlive the object.
  /// @param between called between the steps of the searches for delay and noise, which take most of the time
  /// up to the graph; what it throws ends the work. Empty: nothing is called
  Fusion(const PreparedDrive& drive, const TypeRegistry& registry, std::function<void()> between = {})
      : drive_(drive), registry_(registry), between_(std::move(between)) {}

  /// Does the steps before the graph: placing, delays and noise. The document is empty. A clock that drifts is kept.
  /// @throws errors of the steps
  [[nodiscard]] ModeledDrive estimated(const FusionSettings& settings);
  /// Does the steps up to the graph. An odometry that is late, whose clock drifts, whose
  /// speeds slip or that was not moved rightly is freed of that (clock_drift.hpp, speed_slip.hpp, lag_left.hpp), and told.
  /// @throws InputError if the odometry or the positions were read in a wrong unit or sense (misreading.hpp);
  /// errors of the steps
  [[nodiscard]] ModeledDrive model(const FusionSettings& stated);
  /// Does all steps. @throws errors of the steps
  [[nodiscard]] FusedDrive fuse(const FusionSettings& settings, const MinimizationWatch& watch = {});

 private:
  /// The settings that the placing depends on.
  struct Key {
    GateOptions gate;
    std::map<std::string, std::optional<GateOptions>> gates;  ///< of sources with one of their own
    StartOptions initial_guess;
    bool lever_arm = true;
    double standstill_mps = 0;

    friend bool operator==(const Key&, const Key&) = default;
  };
  [[nodiscard]] FusionSettings decision_on(const FusionSettings& settings) const;
  [[nodiscard]] const PlacedDrive& placed(const FusionSettings& settings);
  /// As estimated(), without the deviations of the noise.
  [[nodiscard]] ModeledDrive searched(const FusionSettings& settings);
  using Readings = std::shared_ptr<const PreparedDrive>;  ///< of a drive; null: those that were read
  /// A drive that may be fused with other readings than those that were read.
  struct Freed {
    ModeledDrive modeled{};
    Readings drive{};
    std::vector<std::string> told{};  ///< warnings about what the readings were freed of

    [[nodiscard]] const PreparedDrive& drive_or(const PreparedDrive& as_read) const {
      return drive ? *drive : as_read;
    }
  };
  /// Fuses a drive with other readings.
  void take(PreparedDrive other, const FusionSettings& settings, Freed& freed) const;
  /// The same, if they are more probable. @param gain least difference of NoiseEstimate::cost @returns whether they
  /// were taken
  bool take_if_better(PreparedDrive other, double gain, const FusionSettings& settings, Freed& freed) const;
  /// Moves the quantity that was late alone by what is left of that. Its search decides, because costs of drives that
  /// stand at other readings cannot be compared.
  void settle_moved_quantity(const FusionSettings& settings, Freed& freed) const;
  /// Takes receivers that err alike for a group, if that is more probable. @returns the settings with that
  [[nodiscard]] FusionSettings with_common_errors(const FusionSettings& stated, Freed& freed);
  /// Gives fixes on both sides of a lasting jump slow errors of their own, if that is more probable.
  void part_at_jumps(const FusionSettings& settings, Freed& freed) const;
  /// Takes out of the fixes that the only receiver smooths them, if that is more probable.
  void free_of_smoothing(const FusionSettings& settings, Freed& freed) const;
  void free_of_slip(const FusionSettings& settings, Freed& freed) const;
  /// Returns where the antenna is, as antenna_of(). An antenna that is elsewhere looks like a slip, too: the odometry is
  /// not freed of one if it is more probable without. @param slipping before it was freed of a slip
  [[nodiscard]] std::optional<AntennaPlace> antenna_beside_slip(const FusionSettings& settings,
                                                                const Freed& slipping, Freed& freed) const;
  /// Puts the odometry on the clock of the fixes, if its own one drifts and that is more probable. A drift that the
  /// noise hid is found in steps.
  void free_of_drift(const FusionSettings& settings, Freed& freed) const;
  /// Moves an odometry that is late to the time of the fixes.
  /// @param antenna where the drive shows it, elsewhere than it is taken to be: fixes that seem early otherwise count
  /// with it alone
  void put_on_time(const FusionSettings& settings, const std::optional<AntennaPlace>& antenna,
                   Freed& freed) const;
  /// Does the steps from there to the graph.
  [[nodiscard]] ModeledDrive completed(Freed freed) const;
  void add_deviations(ModeledDrive& modeled) const;
  /// Returns where the antenna is, if the drive shows it elsewhere than it is taken to be. What comes late looks like an
  /// antenna further behind.
  [[nodiscard]] std::optional<AntennaPlace> antenna_of(const ModeledDrive& modeled,
                                                       const FusionSettings& settings);
  [[nodiscard]] ModeledDrive estimated_from(PlacedDrive placed, const FusionSettings& settings);
  /// Returns the drive with a start along the fixes, if that is more probable: the odometry is then worth little.
  [[nodiscard]] std::optional<ModeledDrive> along_fixes(const PlacedDrive& usual,
                                                        const FusionSettings& settings,
                                                        const ModeledDrive& modeled);

  const PreparedDrive& drive_;
  const TypeRegistry& registry_;
  std::function<void()> between_;
  std::optional<Timeline> timeline_;
  std::list<std::pair<Key, PlacedDrive>> placed_;
};

/// Fills the covariances of a drive at its minimum. Those of poses contain what is not known of the noise
/// (noise_spread.hpp). Errors are those of add_covariances() of a document.
/// @param which "none", "fixes" or "all"
void add_covariances(ModeledDrive& modeled, const std::string& which);

/// Finds the minimum of a modeled drive, and the covariances that its settings request.
[[nodiscard]] FusedDrive minimized(ModeledDrive model, const TypeRegistry& registry,
                                   const MinimizationWatch& watch = {});

}  // namespace waymark::drive
