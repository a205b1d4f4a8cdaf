// Where the fixes show a wrong scale, its prior is widened, and the scale of turns is calibrated; what is stated stays.
#include <catch2/catch.hpp>

#include <waymark/tools/drive/estimation/scale_priors.hpp>

#include "support/registry.hpp"

namespace scale_priors_test {

using namespace waymark;
using namespace waymark::drive;
using namespace waymark_test;

namespace {

PlacedDrive placed_with(double speed_factor, double turn_factor) {
  PlacedDrive placed;
  placed.odometry_name = "wheels";
  placed.speed_factor = speed_factor;
  placed.turn_factor = turn_factor;
  return placed;
}

FusionSettings settings_with(Options calibration) {
  FusionSettings settings;
  settings.calibration = std::move(calibration);
  return settings;
}

}  // namespace

TEST_CASE("scale priors: both scales get the errors that the fixes show") {
  FusionSettings settings = settings_with(default_calibration());
  const auto notes = adapt_to_scales(placed_with(0.5, 0.8), true, registry(), settings);
  CHECK(settings.odometry_options.at("speed_scale_sigma") == "1");   // 1 / 0.5 - 1
  CHECK(settings.odometry_options.at("yaw_scale_sigma") == "0.25");  // 1 / 0.8 - 1
  CHECK(settings.calibration->at("yaw_scale") == "constant");
  REQUIRE(notes.size() == 2);
  CHECK(notes[1] == "yaw_scale_sigma is taken as 0.25, because the turns differ by that");
}

TEST_CASE(
    "scale priors: a bias of the way, as of unequal wheels, is calibrated with a prior as wide as it is") {
  PlacedDrive placed = placed_with(1, 1);
  placed.turn_factor.reset();
  placed.yaw_bias = YawBias{.radpm = -0.004, .sigmas = 20};
  FusionSettings settings = settings_with(default_calibration());
  const auto notes = adapt_to_scales(placed, true, registry(), settings);
  CHECK(settings.calibration->at("yaw_per_speed") == "constant");
  CHECK(settings.odometry_options.at("yaw_per_speed_sigma") == "0.004");
  REQUIRE(notes.size() == 1);
  CHECK(notes[0] == "yaw_per_speed_sigma is taken as 0.004, because the turns per metre differ by that");
  placed.yaw_bias = YawBias{.radps = 0.03, .sigmas = 20};  // a gyro's
  settings = settings_with(default_calibration());
  CHECK(adapt_to_scales(placed, true, registry(), settings).empty());
  CHECK_FALSE(settings.calibration->contains("yaw_per_speed"));
}

TEST_CASE("scale priors: what is stated stays, and a state that is not calibrated has no prior") {
  FusionSettings stated = settings_with({{"gyro_bias", "constant"}, {"speed_scale", "off"}});
  CHECK(adapt_to_scales(placed_with(1.25, 0.8), false, registry(), stated).empty());
  CHECK(stated.odometry_options.empty());
  CHECK_FALSE(stated.calibration->contains("yaw_scale"));
  FusionSettings known = settings_with(default_calibration());
  known.odometry_options["yaw_scale_sigma"] = "0.5";
  CHECK(adapt_to_scales(placed_with(1, 0.8), true, registry(), known).empty());
  CHECK(known.odometry_options.at("yaw_scale_sigma") == "0.5");
  CHECK(known.calibration->at("yaw_scale") == "constant");
}

TEST_CASE("scale priors: of several odometries only that of the nodes is changed") {
  PlacedDrive placed = placed_with(1, 0.8);
  placed.relative.resize(2);
  placed.relative[0].name = "wheels";
  placed.relative[1].name = "visual";
  FusionSettings settings = settings_with(default_calibration());
  (void)adapt_to_scales(placed, true, registry(), settings);
  CHECK(settings.sources.at("wheels").calibration.at("yaw_scale") == "constant");
  CHECK(settings.sources.at("wheels").options.at("yaw_scale_sigma") == "0.25");
  CHECK_FALSE(settings.sources.contains("visual"));
  CHECK_FALSE(settings.calibration->contains("yaw_scale"));
}

}  // namespace scale_priors_test
