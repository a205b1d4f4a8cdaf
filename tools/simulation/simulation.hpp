/// Simulated drives: raw logs of a vehicle that never drove, and its truth. README.md
/// describes the models.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/frame.hpp>
#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/simulation/recipe.hpp>

namespace waymark::simulation {

/// A recipe with a name.
struct SimulationPreset {
  std::string name;
  std::string description;
  SimulationRecipe recipe;
  std::uint64_t default_seed = 1;
};

/// Returns the presets. `highway`, `urban`, `rural`, `mixed`: ten minutes each, with new biases for
/// every seed. `paper-1` ... `paper-8`: like the eight drives of the paper, at their default seed.
/// `three-absolute`, `two-odometries`, `correlated-receivers`: twenty minutes with several sources.
[[nodiscard]] const std::vector<SimulationPreset>& simulation_presets();
/// @throws UsageError for an unknown name; it proposes the nearest one
[[nodiscard]] const SimulationPreset& simulation_preset(std::string_view name);

/// The parts of the error of a fix, in metres on true east and north. Their sum with the bias
/// is the error.
struct FixErrorParts {
  Eigen::Vector2d fast = Eigen::Vector2d::Zero();
  Eigen::Vector2d jitter = Eigen::Vector2d::Zero();
  Eigen::Vector2d burst = Eigen::Vector2d::Zero();
};

/// A fix as it is written into the log.
struct SimulatedFix {
  /// with course and speed; the covariance follows from epx and epy by the rule of the paper
  GeodeticFix fix;
  double epx_m = 0;  ///< stated error at 95 %: east ...
  double epy_m = 0;  ///< ... north ...
  double epv_m = 0;  ///< ... and height
  FixErrorParts parts;
};

/// The readings of one odometry, without those of its outages.
struct SimulatedOdometry {
  std::string name;            ///< of the recipe
  double speed_scale = 0;      ///< drawn for this seed
  double gyro_bias_radps = 0;  ///< drawn for this seed, at the start
  std::vector<OdometrySample> samples;
};

/// The fixes of one receiver. Their positions are those of the antenna.
struct SimulatedGnss {
  std::string name;              ///< of the recipe
  Eigen::Vector2d bias_m{0, 0};  ///< drawn for this seed, true east and north
  std::vector<SimulatedFix> fixes;
};

/// All stamps are GPS time. Positions of the truth are those of the body point, positions of fixes
/// those of the antenna.
struct SimulatedDrive {
  std::string name;  ///< begins with "Simulated"
  std::uint64_t seed = 0;
  SimulationRecipe recipe;
  Frame frame;                        ///< of `poses`
  std::vector<StampedPose> poses;     ///< exact, at the stamps of `truth`; headings are not wrapped
  double distance_m = 0;              ///< on the ground
  Eigen::Vector2d gnss_bias_m{0, 0};  ///< drawn for this seed, true east and north
  double speed_scale = 0;             ///< drawn for this seed
  double gyro_bias_radps = 0;         ///< drawn for this seed, at the start
  std::vector<OdometrySample> odometry;
  std::vector<SimulatedFix> fixes;
  std::vector<GeodeticTruth> truth;
  /// in the order of the recipe; the members above hold the first odometry and the first receiver
  std::vector<SimulatedOdometry> further_odometry;
  std::vector<SimulatedGnss> further_gnss;
};

/// Simulates a drive. The same recipe and seed give the same drive. Road and each source have
/// their own random streams, so a change of one leaves the others as they were.
/// @throws UsageError for an impossible recipe
[[nodiscard]] SimulatedDrive simulate(const SimulationRecipe& recipe, std::uint64_t seed);

/// Writes a log per source (by default `odometry.csv` and `gnss.json`, which is gpsd's),
/// `truth.csv` and `drive.yaml` into an existing folder. Each is labelled as simulated.
/// @throws OutputError
void write_simulated_drive(const SimulatedDrive& drive, const std::string& folder);

}  // namespace waymark::simulation
