/// Simulated drives: raw logs of a vehicle that never drove, with the truth about it. README.md has the
/// models.
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

/// `highway`, `urban`, `rural`, `mixed`: ten minutes each, every seed draws new biases; `paper-1` ...
/// `paper-8`: as the paper's eight drives, at their default seed.
[[nodiscard]] const std::vector<SimulationPreset>& simulation_presets();
/// @throws UsageError for an unknown name, with the nearest one.
[[nodiscard]] const SimulationPreset& simulation_preset(std::string_view name);

/// What the error of a fix is made of, metres on true east and north. Their sum with the bias is the error.
struct FixErrorParts {
  Eigen::Vector2d fast = Eigen::Vector2d::Zero();
  Eigen::Vector2d jitter = Eigen::Vector2d::Zero();
  Eigen::Vector2d burst = Eigen::Vector2d::Zero();
};

/// A fix as it is written into the log.
struct SimulatedFix {
  GeodeticFix fix;   ///< course and speed included; covariance from epx and epy by the paper's rule
  double epx_m = 0;  ///< stated error at 95 %: east ...
  double epy_m = 0;  ///< ... north ...
  double epv_m = 0;  ///< ... and height
  FixErrorParts parts;
};

/// All stamps are GPS time. Positions of truth and fixes are those of the body point: no lever arms.
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
};

/// Simulates a drive. The same recipe and seed give the same drive; road, odometry and GNSS draw from streams
/// of their own, so that changing one leaves the others as they were.
/// @throws UsageError for a recipe that makes no sense.
[[nodiscard]] SimulatedDrive simulate(const SimulationRecipe& recipe, std::uint64_t seed);

/// Writes `odometry.csv`, `gnss.json` (gpsd), `truth.csv` and `drive.yaml` into a folder that exists; each is
/// labelled as simulated.
/// @throws OutputError
void write_simulated_drive(const SimulatedDrive& drive, const std::string& folder);

}  // namespace waymark::simulation
