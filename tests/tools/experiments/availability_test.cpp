// Several sources cover the whole drive, and the result is no worse than the best of them.
#include <catch2/catch.hpp>

#include <cmath>

#include <waymark/tools/drive/model/fuse.hpp>
#include <waymark/tools/drive/model/poses_at_fixes.hpp>
#include <waymark/tools/drive/left_out/without_source.hpp>
#include <waymark/tools/evaluation/evaluation.hpp>
#include <waymark/tools/simulation/simulation.hpp>
#include <waymark/tools/simulation/source_statistics.hpp>
#include <waymark/types_se2/se2.hpp>

#include "support/registry.hpp"
#include "tools/experiments/simulated.hpp"

namespace availability_test {

using namespace waymark;
using namespace waymark::drive;
using namespace waymark::simulation;
using namespace waymark_test;

namespace {

SimulatedDrive simulated(const char* preset) {
  return simulate(with_duration(simulation_preset(preset).recipe, 300), 1);
}

/// States the errors that a receiver of the simulation has.
Options true_errors(const GnssRecipe& recipe) {
  return {{"tails", "normal"},
          {"white_sigma", shortest(recipe.jitter_m)},
          {"multipath_sigma", shortest(recipe.fast_sigma_m)},
          {"multipath_time", shortest(recipe.fast_tau_s)},
          {"bias_floor", shortest(recipe.bias_sigma_m)},
          {"bias_share", "0"},
          {"bias_time", "1e6"},
          {"accuracy_exponent", "0"}};
}

/// States the noise that an odometry of the simulation has.
Options true_noise(const OdometryRecipe& recipe) {
  const std::string heading = shortest(std::pow(recipe.yaw_rate_noise_radps, 2) / recipe.rate_hz);
  return {{"heading_variance_per_s", heading},
          {"gyro_at_rest_variance_per_s", heading},
          {"speed_scale_sigma", "0.02"}};
}

FusionSettings settings_for(const SimulatedDrive& drive) {
  FusionSettings settings;
  settings.estimates_noise = false;
  for (const GnssRecipe& recipe : drive.recipe.all_gnss())
    settings.sources[recipe.name].options = true_errors(recipe);
  for (const OdometryRecipe& recipe : drive.recipe.all_odometry())
    settings.sources[recipe.name].options = true_noise(recipe);
  return settings;
}

struct Result {
  double rmse_m = 0;
  std::size_t poses = 0;
  Stamp first, last;
};

/// Fuses a drive, and compares all of its poses with the exact truth.
Result fused(const PreparedDrive& drive, const FusionSettings& settings, const SimulatedDrive& simulated) {
  const FusedDrive result = fuse(drive, settings, registry());
  REQUIRE(result.minimum.summary.converged());
  const evaluation::Evaluation evaluated =
      evaluation::evaluate(against_truth(result.model.document, simulated));
  REQUIRE(evaluated.truth);
  const std::vector<StampedPose> poses = poses_at_fixes(result.model.document);
  return {evaluated.truth->fused.position.rmse_m, poses.size(), result.model.placed.timeline.stamps.front(),
          result.model.placed.timeline.stamps.back()};
}

}  // namespace

TEST_CASE("availability: three receivers fused are no worse than the best one, at every epoch of the drive") {
  const SimulatedDrive drive = simulated("three-absolute");
  const PreparedDrive prepared = prepared_sources(drive, 1);
  const FusionSettings settings = settings_for(drive);
  const Result all = fused(prepared, settings, drive);
  double best_m = 1e9;
  double most_percent = 0;
  for (const SourceStatistics& source : source_statistics(drive)) {
    if (source.kind != "gnss") continue;
    best_m = std::min(best_m, source.rms_m);
    most_percent = std::max(most_percent, source.availability_percent);
  }
  CHECK(all.rmse_m <= best_m);
  CHECK(most_percent == 100);
  CHECK(all.poses == prepared.fixes.size());
  CHECK(all.first == drive.odometry.front().stamp);
  CHECK(all.last == drive.odometry.back().stamp);
  for (const SourceOfDrive& source : sources_of(prepared)) {
    if (!can_do_without(prepared, source)) continue;
    INFO("without " << source.name);
    CHECK(fused(without_source(prepared, source), settings, drive).rmse_m > 0.97 * all.rmse_m);
  }
}

TEST_CASE("availability: two odometries that are silent at times give a pose at every epoch") {
  const SimulatedDrive drive = simulated("two-odometries");
  const PreparedDrive prepared = prepared_sources(drive, 1);
  REQUIRE(prepared.relative.size() == 2);
  const FusionSettings settings = settings_for(drive);
  const Result all = fused(prepared, settings, drive);
  CHECK(all.poses == prepared.fixes.size());
  for (const SourceOfDrive& source : sources_of(prepared)) {
    if (!can_do_without(prepared, source)) continue;
    INFO("without " << source.name);
    const PreparedDrive rest = without_source(prepared, source);
    CHECK(rest.relative.empty());
    CHECK(rest.odometry_name != source.name);
    CHECK(fused(rest, settings, drive).rmse_m > 0.97 * all.rmse_m);
  }
}

TEST_CASE("availability: receivers whose lasting errors are all in common are no worse than one of them") {
  SimulationRecipe recipe = with_duration(simulation_preset("correlated-receivers").recipe, 300);
  recipe.gnss.common_share = recipe.further_gnss.front().common_share = 1;
  const SimulatedDrive drive = simulate(recipe, 1);
  const PreparedDrive prepared = prepared_sources(drive, 1);
  FusionSettings settings = settings_for(drive);
  settings.sources["front"] = {.common = "rear"};
  const Result all = fused(prepared, settings, drive);
  for (const char* source : {"front", "rear"}) {
    INFO("without " << source);
    CHECK(fused(without_source(prepared, {source, "gnss"}), settings, drive).rmse_m > 0.97 * all.rmse_m);
  }
}

TEST_CASE("availability: a drive cannot do without its only odometry or receiver") {
  const SimulatedDrive drive = simulated("three-absolute");
  const PreparedDrive prepared = prepared_sources(drive, 5);
  std::vector<std::string> needed;
  for (const SourceOfDrive& source : sources_of(prepared))
    if (!can_do_without(prepared, source)) needed.push_back(source.name);
  CHECK(needed == std::vector<std::string>{"wheels"});
  PreparedDrive rest = prepared;
  rest.receivers.resize(1);
  CHECK_FALSE(can_do_without(rest, {"front", "gnss"}));
}

TEST_CASE(
    "availability: the fixes of a source that is left out are withheld, those of others are as they were") {
  const SimulatedDrive drive = simulated("three-absolute");
  const PreparedDrive prepared = prepared_sources(drive, 5);
  const PreparedDrive rest = without_source(prepared, {"rear", "gnss"});
  REQUIRE(rest.fixes.size() == prepared.fixes.size());
  for (const Fix& fix : rest.fixes)
    REQUIRE(fix.status == (fix.source == 1 ? FixStatus::withheld : FixStatus::accepted));
}

}  // namespace availability_test
