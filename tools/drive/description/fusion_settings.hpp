/// How a drive is fused: one plain value that a drive.yaml, the command line, experiments and
/// programs fill.
#pragma once

#include <optional>
#include <string>

#include <waymark/core/registry/options.hpp>
#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/nodes/gate.hpp>
#include <waymark/tools/drive/nodes/start.hpp>

namespace waymark::drive {

/// How a graph is minimised.
struct Minimization {
  /// the values of the graph ("file"), a registered start, or "auto": the best
  std::string start = "file";
  std::string algorithm = "dogleg";
  Options options{};            ///< of the algorithm
  std::string solver = "auto";  ///< auto: the fastest in measurements (solvers/README.md)
  int threads = 1;
  int max_iterations = 500;
  double tolerance = 1e-6;  ///< OptimizerOptions::decrement_tolerance
  /// computed at the minimum: none, those of the fixes' vertices, all
  std::string covariances = "none";

  friend bool operator==(const Minimization&, const Minimization&) = default;
};

/// What is empty is decided by the modeling (see decided()).
struct FusionSettings {
  std::string modeling = "correlated";  ///< registered GNSS modeling
  Options modeling_options{};           ///< of it, checked by its plugin
  std::string
      /// of the fixes, "cauchy:1": a registered loss and its scale; empty or "none": squared
      loss{};
  std::string odometry_model = "constant_twist";  ///< registered odometry model
  Options odometry_options{};                     ///< of it, checked by its plugin
  /// States to estimate with the poses: options that go to the odometry model or the GNSS modeling,
  /// whichever has them. Given without any: no states.
  std::optional<Options> calibration{};
  GateOptions gate{};
  /// whether options with a prior come from the drive (noise.hpp)
  std::optional<bool> estimates_noise{};
  StartOptions initial_guess{};
  bool lever_arm = true;  ///< false: the antenna counts as the body point
  Minimization minimization{};

  friend bool operator==(const FusionSettings&, const FusionSettings&) = default;
};

/// Returns the meaning of `calibration: on`: all states that the built-in plugins know.
[[nodiscard]] Options default_calibration();

/// The settings with nothing left open. For a complete error model (GnssModelingType::complete) that is no
/// gate, all calibration states and an estimated noise; for others the gate, no states and the noise as
/// stated. The modeling's options get the calibration states that it knows.
/// @throws UsageError for an unknown modeling
[[nodiscard]] FusionSettings decided(FusionSettings settings, const TypeRegistry& registry);

/// Options of an odometry model or a GNSS modeling with the calibration states that it knows.
/// @param known  the options that it has
[[nodiscard]] Options with_calibration(Options options, const FusionSettings& settings,
                                       const std::vector<OptionInfo>& known);

/// A loss as FusionSettings::loss names it; empty for squared errors.
/// @param place  of the text, for messages
/// @throws UsageError for an unknown loss, and a scale that is none
[[nodiscard]] std::optional<Loss> loss_of_fixes(const std::string& loss, const TypeRegistry& registry,
                                                const std::string& place = "loss");

/// "NAME:SCALE" as a loss. @throws UsageError as loss_of_fixes
[[nodiscard]] Loss named_loss(const std::string& text, const std::string& place,
                              const TypeRegistry& registry);

}  // namespace waymark::drive
