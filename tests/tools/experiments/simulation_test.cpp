// Simulated drives: their statistics against theory, with fixed seeds. Bounds are a few standard deviations
// of the estimate, or stated beside it.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/coordinates/projection.hpp>
#include <waymark/tools/simulation/sensors/sensors.hpp>
#include <waymark/tools/simulation/simulation.hpp>
#include <waymark/tools/simulation/statistics.hpp>

#include "tools/experiments/simulated.hpp"

namespace simulation_test {

using namespace waymark;
using namespace waymark::drive;
using namespace waymark::simulation;
using std::numbers::pi;
using waymark_test::prepared;
using waymark_test::straight_road;

namespace {

constexpr double kDegree = pi / 180;

OdometryRecipe perfect_odometry() {
  OdometryRecipe odometry;
  odometry.speed_noise_mps = odometry.speed_step_mps = 0;
  odometry.gyro_bias_walk_radps_sqrts = odometry.yaw_rate_noise_radps = odometry.yaw_rate_step_radps = 0;
  return odometry;
}

SimulationRecipe straight_drive(double duration_s, const OdometryRecipe& odometry) {
  SimulationRecipe recipe;
  recipe.duration_s = duration_s;
  recipe.roads = {straight_road()};
  recipe.odometry = odometry;
  return recipe;
}

DriveStatistics statistics_of(const SimulatedDrive& simulated) {
  return drive_statistics(prepared(simulated), GateOptions{});
}

}  // namespace

TEST_CASE("simulation: perfect sensors follow the truth over bends, corners and stops") {
  for (const char* name : {"urban", "rural", "highway"}) {
    SimulationRecipe recipe = simulation_preset(name).recipe;
    recipe.odometry = perfect_odometry();
    recipe.truth.position_noise_m = 0;
    recipe.truth.heading_noise_rad = 0;
    const DriveStatistics statistics = statistics_of(simulate(recipe, 5));
    INFO(name);
    CHECK(statistics.drift_percent < 0.02);
    CHECK(statistics.yaw_drift_deg_per_minute < 0.01);
  }
}

TEST_CASE("simulation: a speed scale alone drifts by itself on a straight road") {
  OdometryRecipe odometry = perfect_odometry();
  odometry.speed_scale = -0.008;
  CHECK(statistics_of(simulate(straight_drive(600, odometry), 1)).drift_percent == Approx(0.8).epsilon(0.01));
}

TEST_CASE("simulation: a constant gyro bias alone drifts by b L / (2 v)") {
  OdometryRecipe odometry = perfect_odometry();
  odometry.gyro_bias_radps = 3e-4;
  const DriveStatistics statistics = statistics_of(simulate(straight_drive(1000, odometry), 1));
  CHECK(statistics.drift_percent == Approx(100 * 3e-4 * 1000 / (2 * 20)).epsilon(0.03));
  CHECK(statistics.yaw_drift_deg_per_minute == Approx(3e-4 * 60 / kDegree).epsilon(0.02));
}

TEST_CASE("simulation: white yaw rate noise alone drifts by sqrt(2 / pi) sqrt(q T / 3)") {
  OdometryRecipe odometry = perfect_odometry();
  odometry.yaw_rate_noise_radps = 0.02;
  const double q = 0.02 * 0.02 / 25;  // rad^2/s: of a heading that sums up readings of 1/25 s
  const double T = 1000.0 / 20;
  const DriveStatistics statistics = statistics_of(simulate(straight_drive(20'000, odometry), 2));
  // 400 km: a normal's mean size from 400 independent pieces, 4 sigma.
  CHECK(statistics.drift_percent ==
        Approx(100 * std::sqrt(2 / pi) * std::sqrt(q * T / 3)).epsilon(4 * 0.76 / 20));
}

TEST_CASE("simulation: the gyro bias walks as far as it is told") {
  OdometryRecipe odometry = perfect_odometry();
  odometry.gyro_bias_walk_radps_sqrts = 1e-4;
  double squares = 0;
  constexpr int seeds = 200;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const SimulatedDrive drive = simulate(straight_drive(20, odometry), seed);
    // A straight road: the gyro reads its bias.
    squares += std::pow(drive.odometry.back().yaw_rate_radps - drive.odometry.front().yaw_rate_radps, 2);
  }
  CHECK(squares / seeds == Approx(1e-8 * (20 - 0.04)).epsilon(4 * std::sqrt(2.0 / seeds)));
}

TEST_CASE("simulation: readings are quantised, and a vehicle at rest reads no speed") {
  const SimulationPreset& preset = simulation_preset("urban");
  const SimulatedDrive drive = simulate(preset.recipe, 3);
  std::size_t standing = 0;
  for (const OdometrySample& sample : drive.odometry) {
    const double speed_steps = sample.speed_mps / preset.recipe.odometry.speed_step_mps;
    const double yaw_steps = sample.yaw_rate_radps / preset.recipe.odometry.yaw_rate_step_radps;
    CHECK(std::abs(speed_steps - std::round(speed_steps)) < 1e-6);
    CHECK(std::abs(yaw_steps - std::round(yaw_steps)) < 1e-6);
    CHECK(sample.speed_mps >= 0);
    if (sample.speed_mps == 0) ++standing;
  }
  CHECK(standing > drive.odometry.size() / 20);
}

TEST_CASE("simulation: the vehicle turns only while it moves, and no sharper than its corners") {
  const SimulatedDrive drive = simulate(simulation_preset("mixed").recipe, 2);
  for (std::size_t i = 1; i < drive.poses.size(); ++i) {
    const Eigen::Vector3d change = drive.poses[i].pose - drive.poses[i - 1].pose;
    // 1 / 9 m is the sharpest corner of the preset's roads.
    CHECK(std::abs(change[2]) <= change.head<2>().norm() / 9 * 1.05 + 1e-12);
  }
}

TEST_CASE("simulation: rates and counts are exact") {
  SimulationRecipe recipe = simulation_preset("rural").recipe;
  recipe.duration_s = 300;
  recipe.gnss.missing_epochs = 17;
  const SimulatedDrive drive = simulate(recipe, 1);
  REQUIRE(drive.odometry.size() == 300 * 25);
  for (std::size_t i = 1; i < drive.odometry.size(); ++i)
    CHECK(drive.odometry[i].stamp.nanoseconds - drive.odometry[i - 1].stamp.nanoseconds == 40'000'000);
  CHECK(drive.fixes.size() == 299 - 17);  // whole seconds 1 to 299
  for (const SimulatedFix& fix : drive.fixes) {
    CHECK(fix.fix.stamp.nanoseconds % 1'000'000'000 == 0);
    CHECK(fix.fix.stamp > drive.odometry.front().stamp);
    CHECK(fix.fix.stamp < drive.odometry.back().stamp);
  }
  CHECK(drive.truth.size() == 300 * 5);
}

TEST_CASE("simulation: errors of the fixes are the sum of their parts, the truth is good to its noise") {
  const SimulatedDrive drive = simulate(simulation_preset("urban").recipe, 4);
  const Projection projection(drive.frame);
  double squares = 0;
  for (std::size_t i = 0; i < drive.truth.size(); ++i)
    squares += (projection.project(drive.truth[i]).position - drive.poses[i].pose.head<2>()).squaredNorm();
  CHECK(std::sqrt(squares / static_cast<double>(2 * drive.truth.size())) == Approx(0.01).epsilon(0.05));

  for (const SimulatedFix& fix : drive.fixes) {
    const auto second = static_cast<std::size_t>(
        (fix.fix.stamp.nanoseconds - drive.poses.front().stamp.nanoseconds) / 1'000'000'000);
    const Eigen::Vector2d truth = drive.poses[5 * second].pose.head<2>();
    const GridPoint grid = projection.to_grid({fix.fix.latitude_deg, fix.fix.longitude_deg});
    const Eigen::Vector2d error = drive.gnss_bias_m + fix.parts.fast + fix.parts.jitter + fix.parts.burst;
    CHECK((grid.position - truth).norm() == Approx(grid.scale * error.norm()).margin(1e-6));
    // Convergence at 10.5 degrees east, 1.5 from the zone's meridian, is 1.2 degrees.
    CHECK((grid.position - truth - error).norm() < 0.03 * error.norm() + 1e-6);
  }
}

TEST_CASE("simulation: receivers state what they know, and little of a burst") {
  SimulationRecipe recipe = simulation_preset("urban").recipe;
  recipe.gnss.stated_95_m = 2;
  recipe.gnss.burst_size_m = 50;
  const SimulatedDrive drive = simulate(recipe, 4);
  double largest = 0;
  for (const SimulatedFix& fix : drive.fixes) {
    CHECK(std::abs(std::remainder(fix.epx_m, 0.01)) < 1e-9);
    CHECK(fix.epy_m == Approx(1.15 * fix.epx_m).margin(0.02));
    CHECK(fix.epv_m > fix.epy_m);
    CHECK(fix.fix.covariance_en(0, 0) == Approx(std::pow(fix.epx_m / 2, 2)));
    CHECK(fix.epx_m < 2 * (1 + 5 * 0.15) + 0.05 * fix.parts.burst.norm() + 0.01);
    largest = std::max(largest, fix.parts.burst.norm());
  }
  CHECK(largest > 20);
}

TEST_CASE("simulation: bursts come at their rate, only from canyons, with their size") {
  GnssRecipe recipe;
  recipe.bursts_per_minute = 2;
  recipe.burst_size_m = 3;
  recipe.burst_duration_s = 5;
  recipe.burst_rise_s = recipe.burst_decay_s = 1e-3;
  constexpr std::size_t epochs = 300'000;
  double squares = 0;
  for (const Eigen::Vector2d& burst : draw_bursts(std::vector<bool>(epochs, true), recipe, {1, 1}))
    squares += burst.squaredNorm();
  // Campbell: rate x E[size^2] x duration, with 2 m^2 for the square of an exponential size.
  CHECK(squares / epochs == Approx(2.0 / 60 * 2 * 9 * 5).epsilon(0.15));

  recipe.rate_hz = 5;
  squares = 0;
  for (const Eigen::Vector2d& burst : draw_bursts(std::vector<bool>(5 * epochs, true), recipe, {1, 1}))
    squares += burst.squaredNorm();
  CHECK(squares / (5 * epochs) == Approx(2.0 / 60 * 2 * 9 * 5).epsilon(0.15));

  std::vector<bool> canyon(1000, false);
  for (const Eigen::Vector2d& burst : draw_bursts(canyon, recipe, {1, 1})) CHECK(burst.norm() == 0);
  for (std::size_t i = 500; i < 600; ++i) canyon[i] = true;
  const std::vector<Eigen::Vector2d> some = draw_bursts(canyon, recipe, {1, 1});
  for (std::size_t i = 0; i < 500; ++i) CHECK(some[i].norm() == 0);
}

TEST_CASE("simulation: outages miss exactly so many epochs, in pieces of their mean length") {
  const std::vector<bool> out = draw_outages(1'000'000, 50'000, 10, {1, 1});
  std::size_t missing = 0;
  std::size_t pieces = 0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    missing += out[i];
    pieces += out[i] && (i == 0 || !out[i - 1]);
  }
  CHECK(missing == 50'000);
  // An exponential length of mean m rounded up has the mean 1 / (1 - exp(-1 / m)); some 5 % of pieces touch.
  CHECK(50'000.0 / static_cast<double>(pieces) == Approx(1 / (1 - std::exp(-0.1))).epsilon(0.1));
}

TEST_CASE("simulation: every seed draws biases of the stated size") {
  SimulationRecipe recipe = simulation_preset("rural").recipe;
  recipe = with_duration(recipe, 10);
  double gnss = 0;
  double gyro = 0;
  double scale = 0;
  constexpr int seeds = 500;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const SimulatedDrive drive = simulate(recipe, seed);
    gnss += drive.gnss_bias_m.squaredNorm() / 2;
    gyro += std::pow(drive.gyro_bias_radps, 2);
    scale += std::pow(drive.speed_scale, 2);
  }
  const double margin = 4 * std::sqrt(2.0 / seeds);
  CHECK(gnss / seeds == Approx(1.2 * 1.2 + 0.6 * 0.6 * 1.5 * 1.5).epsilon(margin));
  CHECK(std::sqrt(gyro / seeds) == Approx(recipe.odometry.gyro_bias_sigma_radps).epsilon(margin / 2));
  CHECK(std::sqrt(scale / seeds) == Approx(recipe.odometry.speed_scale_sigma).epsilon(margin / 2));
}

TEST_CASE("simulation: the same seed gives the same drive, another seed another") {
  const SimulationRecipe recipe = with_duration(simulation_preset("urban").recipe, 60);
  const SimulatedDrive a = simulate(recipe, 11);
  const SimulatedDrive b = simulate(recipe, 11);
  const SimulatedDrive c = simulate(recipe, 12);
  REQUIRE(a.fixes.size() == b.fixes.size());
  for (std::size_t i = 0; i < a.fixes.size(); ++i)
    CHECK(a.fixes[i].fix.latitude_deg == b.fixes[i].fix.latitude_deg);
  for (std::size_t i = 0; i < a.odometry.size(); ++i)
    CHECK(a.odometry[i].yaw_rate_radps == b.odometry[i].yaw_rate_radps);
  CHECK(a.fixes.back().fix.latitude_deg != c.fixes.back().fix.latitude_deg);
  CHECK(a.distance_m != c.distance_m);
}

TEST_CASE("simulation: road, odometry and GNSS draw apart from each other") {
  SimulationRecipe recipe = with_duration(simulation_preset("urban").recipe, 60);
  const SimulatedDrive before = simulate(recipe, 1);
  recipe.gnss.fast_sigma_m *= 2;
  recipe.gnss.bursts_per_minute *= 3;
  recipe.gnss.missing_epochs += 5;
  const SimulatedDrive other_gnss = simulate(recipe, 1);
  CHECK(other_gnss.poses.back().pose == before.poses.back().pose);
  CHECK(other_gnss.odometry.back().speed_mps == before.odometry.back().speed_mps);
  CHECK(other_gnss.odometry.back().yaw_rate_radps == before.odometry.back().yaw_rate_radps);
  CHECK(other_gnss.truth.back().latitude_deg == before.truth.back().latitude_deg);
  CHECK(other_gnss.fixes.back().parts.jitter == before.fixes.back().parts.jitter);

  recipe.odometry.speed_noise_mps *= 2;
  recipe.odometry.speed_scale_sigma *= 2;
  const SimulatedDrive other_odometry = simulate(recipe, 1);
  CHECK(other_odometry.fixes.back().fix.latitude_deg == other_gnss.fixes.back().fix.latitude_deg);
  CHECK(other_odometry.poses.back().pose == before.poses.back().pose);
}

TEST_CASE("simulation: drift compares pieces that are laid onto the truth at their start") {
  std::vector<Eigen::Vector3d> truth;
  std::vector<Eigen::Vector3d> turned;  // elsewhere, turned, and 2 % too long
  for (int i = 0; i <= 3000; ++i) {
    truth.emplace_back(i, 0, 0);
    turned.emplace_back(50, 70 + 1.02 * i, pi / 2);
  }
  CHECK(mean_drift(truth, truth) == Approx(0).margin(1e-12));
  CHECK(mean_drift(turned, truth) == Approx(0.02).epsilon(1e-6));
  truth.resize(900);
  turned.resize(900);
  CHECK(std::isnan(mean_drift(turned, truth)));
}

TEST_CASE("simulation: the paper's presets are like the paper's drives") {
  // Tables dataset_overview and GNSS_metrics of the paper.
  struct Paper {
    double distance_km;
    std::size_t fixes;
    std::size_t odometry_points;
    double rejected_percent, max_m, accuracy_m, precision_m;
  };
  const std::vector<Paper> drives = {
      {24, 1814, 46131, 14.88, 66.291, 0.489, 2.653}, {8, 2495, 63042, 26.18, 21.799, 0.874, 2.491},
      {37, 3354, 85226, 57.43, 49.068, 0.715, 2.293}, {25, 2716, 68351, 24.30, 4.828, 1.089, 1.025},
      {19, 2458, 61479, 24.41, 16.776, 0.678, 1.141}, {24, 1585, 39685, 25.91, 3.672, 0.336, 0.954},
      {26, 3281, 82313, 9.53, 7.775, 0.782, 1.177},   {25, 4188, 104949, 29.37, 18.037, 0.805, 1.264}};
  for (std::size_t i = 0; i < drives.size(); ++i) {
    const Paper& paper = drives[i];
    const SimulationPreset& preset = simulation_preset("paper-" + std::to_string(i + 1));
    INFO(preset.name);
    const SimulatedDrive drive = simulate(preset.recipe, preset.default_seed);
    const DriveStatistics statistics = statistics_of(drive);
    CHECK(statistics.odometry_points == paper.odometry_points);
    CHECK(statistics.fixes == paper.fixes);
    CHECK(drive.distance_m / 1000 == Approx(paper.distance_km).epsilon(0.02));
    CHECK(statistics.distance_m / 1000 == Approx(paper.distance_km).epsilon(0.02));
    CHECK(statistics.rejected_percent == Approx(paper.rejected_percent).margin(5));
    CHECK(statistics.gnss.max_m == Approx(paper.max_m).epsilon(0.1));
    CHECK(statistics.gnss.accuracy_m == Approx(paper.accuracy_m).epsilon(0.1));
    CHECK(statistics.gnss.precision_m == Approx(paper.precision_m).epsilon(0.1));
    CHECK(statistics.drift_percent == Approx(1.1).margin(0.1));
    // Not one planted spike: without its largest burst a drive still has others.
    std::size_t bursts = 0;
    bool inside = false;
    for (const SimulatedFix& fix : drive.fixes) {
      const bool now = fix.parts.burst.norm() > 0.5;
      bursts += now && !inside;
      inside = now;
    }
    CHECK(bursts >= 5);
  }
}

TEST_CASE("simulation: recipes that make no sense are refused by name") {
  using Catch::Matchers::Message;
  SimulationRecipe recipe = simulation_preset("urban").recipe;
  recipe.gnss.fast_tau_s = 0;
  CHECK_THROWS_MATCHES(simulate(recipe, 1), UsageError,
                       Message("simulation recipe: gnss.fast_tau_s must be a number above 0, got 0"));
  recipe = simulation_preset("urban").recipe;
  recipe.odometry.rate_hz = 30;
  CHECK_THROWS_MATCHES(simulate(recipe, 1), UsageError,
                       Message("simulation recipe: odometry.rate_hz must be a divisor of 100 Hz, got 30"));
  recipe = simulation_preset("urban").recipe;
  recipe.roads.clear();
  CHECK_THROWS_AS(simulate(recipe, 1), UsageError);
  CHECK_THROWS_MATCHES(simulation_preset("paper-9"), UsageError,
                       Message("unknown preset 'paper-9'; there are: highway, urban, rural, mixed, varied, "
                               "paper-1, paper-2, paper-3, paper-4, paper-5, paper-6, paper-7, paper-8, "
                               "three-absolute, two-odometries, correlated-receivers"));
}

}  // namespace simulation_test
