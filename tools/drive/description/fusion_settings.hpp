/// How a drive is fused. This is a plain value that a drive.yaml, the command line, experiments and
/// programs fill.
#pragma once

#include <map>
#include <optional>
#include <string>

#include <waymark/core/registry/options.hpp>
#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/nodes/gate.hpp>
#include <waymark/tools/drive/nodes/start.hpp>
#include <waymark/tools/drive/nodes/yaw_rate_at_rest.hpp>

namespace waymark::drive {

/// How a graph is minimised.
struct Minimization {
  /// the values of the graph ("file"), a registered start, or "auto": the best
  std::string start = "file";
  std::string algorithm = "dogleg";
  Options options{};            ///< of the algorithm
  std::string solver = "auto";  ///< auto: the fastest in measurements (solvers/README.md)
  Options solver_options{};
  int threads = 1;
  int max_iterations = 500;
  double tolerance = 1e-6;  ///< OptimizerOptions::decrement_tolerance
  /// covariances to compute at the minimum: none, fixes (vertices of fixes) or all
  std::string covariances = "none";

  friend bool operator==(const Minimization&, const Minimization&) = default;
};

/// What is stated for one source. It goes before what is stated for the drive.
struct SourceSettings {
  /// modeling of an absolute source, odometry model of a relative one; empty: that of the drive
  std::string model{};
  Options options{};  ///< of it; those of the drive stay if the model is that of the drive
  Options calibration{};
  std::optional<std::string> loss{};  ///< of its measurements, as FusionSettings::loss
  std::optional<GateOptions> gate{};
  /// Another absolute source that has the same lasting errors, such as a receiver that sees the same
  /// satellites. Both are one group, with the settings of the source that is named.
  std::string common{};

  friend bool operator==(const SourceSettings&, const SourceSettings&) = default;
};

/// The modeling decides about empty members (see decided()).
struct FusionSettings {
  std::string modeling = "correlated";  ///< registered GNSS modeling
  Options modeling_options{};           ///< of it, checked when it is made
  /// loss of the fixes, "cauchy:1": a registered loss and its scale; empty or "none":
  /// squared errors
  std::string loss{};
  std::string odometry_model = "constant_twist";  ///< registered odometry model
  Options odometry_options{};                     ///< of it, checked when it is made
  /// States that are estimated with the poses: options for the odometry model or the GNSS modeling,
  /// whichever has them. An empty map means: no states.
  std::optional<Options> calibration{};
  GateOptions gate{};
  /// whether options with a prior are estimated from the drive (noise.hpp)
  std::optional<bool> estimates_noise{};
  StartOptions initial_guess{};
  bool lever_arm = true;  ///< false: the antenna is taken as the body point
  Minimization minimization{};
  std::map<std::string, SourceSettings> sources{};  ///< by name of the source
  /// Files that options of models name are below this folder, unless they are absolute. decided()
  /// resolves them, and empties it.
  std::string folder{};

  friend bool operator==(const FusionSettings&, const FusionSettings&) = default;
};

/// Returns the meaning of `calibration: on`: bias, scale and delay. Further states are added where the drive shows that
/// they are needed (yaw_per_speed, yaw_scale).
[[nodiscard]] Options default_calibration();

/// Completes the settings with the defaults of the modeling. A complete error model
/// (GnssModelingType::complete) has no gate, all calibration states and an estimated noise. Others
/// have the gate, no states and the noise as stated. The options of the modeling receive the
/// calibration states that it knows.
/// @throws UsageError for an unknown modeling
[[nodiscard]] FusionSettings decided(FusionSettings settings, const TypeRegistry& registry);

/// Returns the settings of one absolute source: modeling, its options, loss and gate are its own. A member
/// of a group has those of its first source.
/// @param settings from decided()
[[nodiscard]] FusionSettings for_absolute(const FusionSettings& settings, const std::string& source,
                                          const TypeRegistry& registry);
/// Returns the settings of one relative source: odometry model, options and calibration are its own.
[[nodiscard]] FusionSettings for_relative(const FusionSettings& settings, const std::string& source);

/// Returns the name of the source whose settings and errors a source has: its own, or that of its group.
/// @throws UsageError if groups name each other in a ring
[[nodiscard]] std::string group_of(const FusionSettings& settings, const std::string& source);

/// Checks the modeling of a group of several sources. @throws UsageError for one of white noise only
void require_common_errors(const FusionSettings& settings, const std::string& group,
                           const TypeRegistry& registry);

/// Adapts decided settings to the yaw rate at rest, if the odometry model has the options: one from
/// wheels or steering shows no bias there and errs in proportion to the speed, and a noisy gyro shows
/// its bias less well. Stated options are kept.
/// @param by_default the calibration was not stated
void adapt_to_yaw_rate(const YawRateAtRest& rest, bool by_default, FusionSettings& settings,
                       const TypeRegistry& registry);

/// Adapts those of one of several relative sources alone. @param source its name
void adapt_to_yaw_rate_of(const std::string& source, const YawRateAtRest& rest, bool by_default,
                          FusionSettings& settings, const TypeRegistry& registry);

/// Returns the options of an odometry model or a GNSS modeling, with the calibration states
/// that it knows.
/// @param known the options that it has
[[nodiscard]] Options with_calibration(Options options, const FusionSettings& settings,
                                       const std::vector<OptionInfo>& known);

/// Returns the loss that FusionSettings::loss names; empty for squared errors.
/// @param place place of the text, for messages
/// @throws UsageError for an unknown loss or an impossible scale
[[nodiscard]] std::optional<Loss> loss_of_fixes(const std::string& loss, const TypeRegistry& registry,
                                                const std::string& place = "loss");

/// Returns the loss that is stated for the measurements of a relative source or a sensor.
/// @param unstated the loss where none is stated, as text @throws UsageError as loss_of_fixes
[[nodiscard]] std::optional<Loss> loss_of_source(const FusionSettings& settings, const std::string& source,
                                                 const TypeRegistry& registry,
                                                 const std::string& unstated = "none");

/// Converts "NAME:SCALE" to a loss. @throws UsageError as loss_of_fixes
[[nodiscard]] Loss named_loss(const std::string& text, const std::string& place,
                              const TypeRegistry& registry);

}  // namespace waymark::drive
