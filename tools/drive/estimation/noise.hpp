/// Estimates the noise of a drive from the drive itself: those options of its odometry model, its
/// GNSS modeling and its further sensors that have a prior. It uses the marginal likelihood of the fixes
/// (core/covariance/evidence.hpp).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/stamp.hpp>
#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/model/place.hpp>

namespace waymark::drive {

/// A parameter further from its prior than this many deviations is not that of a sound drive.
inline constexpr double kUsualNoise = 4;
/// The search may leave the prior of an odometry by this many deviations towards more noise: a gyro that is dead has
/// 0.3 rad in a second, and is worth nothing only if that can be found. Everything else ends at kUsualNoise: fixes
/// that are hundreds of times worse than they claim would explain any odometry.
inline constexpr double kNoiseReach = 8;

/// Returns the prior for receivers that claim an accuracy (NoisePrior::shrinks_with_claim).
/// @param accuracy_m median; 0: none is claimed
[[nodiscard]] NoisePrior prior_for(const NoisePrior& general, double accuracy_m);

/// The estimate of one option.
struct NoiseParameter {
  std::string source;  ///< of the drive, if it has several of that kind or is a sensor; otherwise empty
  std::string owner;   ///< the odometry model, modeling or sensor model that has the option
  std::string option;
  std::string unit;
  OptionRange range;  ///< what the option allows
  NoisePrior prior;
  double reach = kUsualNoise;  ///< how many deviations of the prior above it the search ends
  double value = 0;
  /// Standard deviation of the posterior, in the form of the prior (of the logarithm, or linear),
  /// whatever the other parameters are. 0: not known yet
  double deviation = 0;

  /// Returns the option with its source if there are several: "front.white_sigma".
  [[nodiscard]] std::string name() const { return source.empty() ? option : source + "." + option; }
  /// Tells whether the drive has more information about it than the prior.
  [[nodiscard]] bool observed() const { return deviation < 0.9 * prior.deviation; }
};

/// What is added to the covariance of a pose because its noise is not known well (noise_spread.hpp).
struct PoseSpread {
  Stamp stamp;
  Eigen::Matrix3d covariance;  ///< x, y in frame axes, m; heading, rad
};

struct NoiseEstimate {
  std::vector<NoiseParameter> parameters;
  /// n x n, of -log of prior times likelihood by coordinates (noise_objective.hpp), as the search left it
  Eigen::MatrixXd curvature;
  std::vector<PoseSpread> spread;  ///< in order of time; empty: not known
  double cost = 0;                 ///< -log of prior times likelihood, with the first relative source
  int evaluations = 0;             ///< evaluations of the marginal likelihood
  double seconds = 0;

  /// Tells whether an odometry was given more noise than a sound one may have. @param name of the source
  [[nodiscard]] bool is_poor_odometry(const std::string& name) const;
  /// Tells whether fixes were given far more noise than they claim (2.5 deviations of a prior).
  [[nodiscard]] bool fixes_are_poor() const;
};

/// Maximises prior times marginal likelihood over the options with a prior that the settings do not
/// state. Fixes are thinned to one in 7.5 s per receiver: receivers smooth their output, and the
/// white noise would otherwise come out too small. Each relative source is estimated without the others:
/// over short times they agree better than over long ones, which is what matters. The first one is
/// estimated with all absolute sources and further sensors. Nodes are thinned as coarse.hpp says. The search
/// for a long drive begins in a piece of it.
/// @param sensors further ones, which take part
/// @param settings from decided()
/// It begins with usual noise; with an odometry that is worth little where the start follows the fixes.
/// @param near an estimate of the same parameters for slightly other settings, to begin from
/// @return values without deviations; no parameters if none is left to estimate
/// @param between called before every building of a graph, some hundred times, and after every step of the optimizer
/// in it; what it throws ends the search.
/// Empty: nothing is called
/// @throws UsageError and InputError as the odometry model and the modeling do
[[nodiscard]] NoiseEstimate estimate_noise(const PlacedDrive& placed, std::span<const PreparedSensor> sensors,
                                           const FusionSettings& settings, const TypeRegistry& registry,
                                           const NoiseEstimate& near = {},
                                           const std::function<void()>& between = {});

/// Tells whether the search may find a lower minimum where the odometry is worth little: a parameter is far beyond
/// its prior, or such an odometry, as it is, costs at most 2.5 more for each fix. (Simulated drives with wheels that
/// slip: 1.4 to 2; sound ones: 3 to 6; 40 fixes beside a wall: 1.4.)
/// @param along the drive with the start that follows the fixes @param noise of the usual start
[[nodiscard]] bool may_be_poor_odometry(const PlacedDrive& along, std::span<const PreparedSensor> sensors,
                                        const FusionSettings& settings, const TypeRegistry& registry,
                                        const NoiseEstimate& noise);

/// Finds how well the values are known, where they stand, and what that means for the poses; for this, those of
/// further relative sources count as known. @param settings as of the estimate
void find_deviations(const PlacedDrive& placed, std::span<const PreparedSensor> sensors,
                     const FusionSettings& settings, const TypeRegistry& registry, NoiseEstimate& noise,
                     const std::function<void()>& between = {});

/// Returns the settings with the estimates as options of the models.
/// Stated options are kept.
[[nodiscard]] FusionSettings with_noise(FusionSettings settings, const NoiseEstimate& noise);

/// Returns the settings without the options that with_noise() gave them.
[[nodiscard]] FusionSettings without_noise(FusionSettings settings, const NoiseEstimate& noise);

}  // namespace waymark::drive
