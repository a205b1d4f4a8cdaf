/// The main job as a component: a drive that was read (load_drive) becomes a graph, and the graph a minimum.
///
///   const DriveFile file = load_drive_file("drive.yaml");
///   const PreparedDrive drive = load_drive(file.description, registry);
///   const FusedDrive fused = fuse(drive, file.settings, registry);
///   for (const StampedPose& pose : poses_at_fixes(fused.model.document)) ...
///
/// The steps: decided() closes what the settings leave to the modeling; place_drive() judges the fixes and
/// guesses all poses; estimate_noise() finds the noise parameters; build_graph() makes the graph; minimize()
/// finds its minimum. `waymark run`, `convert`, causal predictions and the experiments all come this way.
///
/// Ownership: results are values, and refer to nothing. Threads: the functions keep no state, and calls on
/// different drives may run side by side, also with one registry; a Fusion serves one thread at a time.
/// Errors: UsageError for settings that name what the registry does not have, InputError for a drive that
/// cannot be fused; a minimum that is not reached is no error but MultiStartSummary::summary.termination.
#pragma once

#include <list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <waymark/core/optimize/multi_start.hpp>
#include <waymark/core/registry/registry.hpp>
#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>
#include <waymark/tools/drive/model/minimize.hpp>
#include <waymark/tools/drive/model/noise.hpp>
#include <waymark/tools/drive/model/place.hpp>

namespace waymark::drive {

/// A drive under one model of its errors, at its initial guess.
struct ModeledDrive {
  FusionSettings settings;  ///< decided; the estimated noise is among the options
  PlacedDrive placed;       ///< nodes, gate, initial guess
  NoiseEstimate noise;      ///< no parameters if it is as stated
  std::vector<std::string> sensor_warnings;
  double distance_m = 0;              ///< by the odometry
  formats::GraphDocument document{};  ///< with provenance: provenance.hpp

  /// What looks wrong about the logs, in sentences.
  [[nodiscard]] std::vector<std::string> warnings() const;
};

/// The same at its minimum.
struct FusedDrive {
  /// the document holds the best values, and the covariances that were asked for
  ModeledDrive model;
  MultiStartSummary minimum;  ///< how it was found
};

/// Fuses a drive.
/// @param drive  as load_drive or prepare_drive gives it; sensors among it take part
/// @throws what the steps throw
[[nodiscard]] FusedDrive fuse(const PreparedDrive& drive, const FusionSettings& settings,
                              const TypeRegistry& registry, const MinimizationWatch& watch = {});

/// Fuses one drive in several ways. Ways that agree on gate and initial guess share them, and all
/// share the nodes in time.
class Fusion {
 public:
  /// Both must outlive the object.
  Fusion(const PreparedDrive& drive, const TypeRegistry& registry) : drive_(drive), registry_(registry) {}

  /// The steps up to the graph. @throws what the steps throw
  [[nodiscard]] ModeledDrive model(const FusionSettings& settings);
  /// All steps. @throws what the steps throw
  [[nodiscard]] FusedDrive fuse(const FusionSettings& settings, const MinimizationWatch& watch = {});

 private:
  /// What placing depends on.
  struct Key {
    GateOptions gate;
    StartOptions initial_guess;
    bool lever_arm = true;
    double standstill_mps = 0;

    friend bool operator==(const Key&, const Key&) = default;
  };
  [[nodiscard]] const PlacedDrive& placed(const FusionSettings& settings);

  const PreparedDrive& drive_;
  const TypeRegistry& registry_;
  std::optional<Timeline> timeline_;
  std::list<std::pair<Key, PlacedDrive>> placed_;
};

/// Finds the minimum of a modeled drive, and the covariances that its settings ask for.
[[nodiscard]] FusedDrive minimized(ModeledDrive model, const TypeRegistry& registry,
                                   const MinimizationWatch& watch = {});

}  // namespace waymark::drive
