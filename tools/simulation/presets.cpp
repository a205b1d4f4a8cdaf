#include <cmath>
#include <numbers>
#include <utility>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/suggest.hpp>
#include <waymark/tools/simulation/random.hpp>
#include <waymark/tools/simulation/simulation.hpp>
#include <waymark/tools/simulation/streams.hpp>

namespace waymark::simulation {
namespace {

RoadRecipe highway() {
  return {.kind = "highway",
          .cruise_min_mps = 22,
          .cruise_max_mps = 33,
          .speed_wander = 0.05,
          .acceleration_mps2 = 1.0,
          .deceleration_mps2 = 1.4,
          .leg_min_m = 2000,
          .leg_max_m = 6000,
          .straight_m = 600,
          .bend_sigma_deg = 15,
          .bend_radius_min_m = 600,
          .bend_radius_max_m = 2000,
          .corner_probability = 0.1,
          .corner_radius_m = 40,
          .stop_probability = 0.15,
          .stop_min_s = 3,
          .stop_max_s = 30,
          .canyon_probability = 0.25};
}

RoadRecipe urban() {
  return {.kind = "urban",
          .cruise_min_mps = 8,
          .cruise_max_mps = 14,
          .speed_wander = 0.08,
          .acceleration_mps2 = 1.5,
          .deceleration_mps2 = 2.0,
          .leg_min_m = 80,
          .leg_max_m = 350,
          .straight_m = 80,
          .bend_sigma_deg = 12,
          .bend_radius_min_m = 40,
          .bend_radius_max_m = 200,
          .corner_probability = 0.35,
          .corner_radius_m = 9,
          .stop_probability = 0.5,
          .stop_min_s = 5,
          .stop_max_s = 45,
          .canyon_probability = 0.5};
}

/// A motorway with too much traffic.
RoadRecipe congested() {
  RoadRecipe road = highway();
  road.kind = "congested highway";
  road.cruise_min_mps = 5;
  road.cruise_max_mps = 14;
  road.speed_wander = 0.12;
  road.leg_min_m = 300;
  road.leg_max_m = 1500;
  road.corner_probability = 0;
  road.stop_probability = 0.5;
  road.stop_min_s = 5;
  road.stop_max_s = 40;
  return road;
}

RoadRecipe rural() {
  return {};
}

RoadRecipe with_share(RoadRecipe road, double share) {
  road.share = share;
  return road;
}

/// Sets the stops of a road: their probability at the end of a leg, and their duration.
RoadRecipe with_stops(RoadRecipe road, double probability, double min_s, double max_s) {
  road.stop_probability = probability;
  road.stop_min_s = min_s;
  road.stop_max_s = max_s;
  return road;
}

/// Returns a drive of ten minutes. Its bias is drawn from the prior of the default model, so the
/// prior is true.
SimulationRecipe consistency(std::string name, std::vector<RoadRecipe> roads, double fast_sigma_m) {
  SimulationRecipe recipe{.name = std::move(name), .duration_s = 600, .roads = std::move(roads)};
  recipe.odometry.speed_scale_sigma = 0.006;
  recipe.odometry.gyro_bias_sigma_radps = 5e-4;
  recipe.gnss.fast_sigma_m = fast_sigma_m;
  recipe.gnss.bias_sigma_m = std::hypot(1.1, 0.75 * fast_sigma_m);
  recipe.gnss.jitter_m = 0.3;
  recipe.gnss.stated_95_m = 2 * fast_sigma_m;
  recipe.gnss.missing_epochs = 10;
  return recipe;
}

/// The differences between the drives of the paper besides their roads. The values are fitted
/// (README.md).
struct PaperDrive {
  int number = 0;
  double distance_m = 0;
  int odometry_points = 0;
  int fixes = 0;
  double gyro_bias_radps = 0;
  Eigen::Vector2d bias_m{0, 0};
  double fast_sigma_m = 0;
  double jitter_m = 0;
  double bursts_per_minute = 0;
  double burst_size_m = 0;
  double burst_duration_s = 0;
};

SimulationRecipe paper_recipe(const PaperDrive& drive, std::vector<RoadRecipe> roads) {
  SimulationRecipe recipe{.name = "paper-" + std::to_string(drive.number), .roads = std::move(roads)};
  recipe.duration_s = drive.odometry_points / recipe.odometry.rate_hz;
  recipe.distance_m = drive.distance_m;
  // The last sample is 3 / 100 s before the end of the duration; the first PPS epoch is at 1 s.
  const int epochs = static_cast<int>(recipe.duration_s - 0.03);
  recipe.odometry.speed_scale = drive.number % 2 == 0 ? 0.004 : -0.004;
  recipe.odometry.gyro_bias_radps = drive.gyro_bias_radps;
  recipe.gnss.bias_east_m = drive.bias_m[0];
  recipe.gnss.bias_north_m = drive.bias_m[1];
  recipe.gnss.fast_sigma_m = drive.fast_sigma_m;
  recipe.gnss.fast_tau_s = 45;
  recipe.gnss.smoothing_s = 4;
  recipe.gnss.jitter_m = drive.jitter_m;
  recipe.gnss.bursts_per_minute = drive.bursts_per_minute;
  recipe.gnss.burst_size_m = drive.burst_size_m;
  recipe.gnss.burst_duration_s = drive.burst_duration_s;
  recipe.gnss.missing_epochs = epochs - drive.fixes;
  return recipe;
}

std::vector<SimulationPreset> paper_presets() {
  std::vector<SimulationPreset> all;
  const auto add = [&all](const PaperDrive& drive, std::vector<RoadRecipe> roads, const char* environment,
                          std::uint64_t seed) {
    SimulationRecipe recipe = paper_recipe(drive, std::move(roads));
    all.push_back({recipe.name, "as the paper's drive " + std::to_string(drive.number) + ": " + environment,
                   std::move(recipe), seed});
  };
  add({.number = 1,
       .distance_m = 24000,
       .odometry_points = 46131,
       .fixes = 1814,
       .gyro_bias_radps = 0.000279,
       .bias_m = {0.216, 0.342},
       .fast_sigma_m = 1.09,
       .jitter_m = 0.0559,
       .bursts_per_minute = 2,
       .burst_size_m = 17.6,
       .burst_duration_s = 1.5},
      {with_share(highway(), 0.25), with_share(congested(), 0.5), with_share(highway(), 0.25)}, "highway", 1);
  add({.number = 2,
       .distance_m = 8000,
       .odometry_points = 63042,
       .fixes = 2495,
       .gyro_bias_radps = 0.0001,
       .bias_m = {0.997, 0.806},
       .fast_sigma_m = 1.32,
       .jitter_m = 0.196,
       .bursts_per_minute = 1.5,
       .burst_size_m = 3.91,
       .burst_duration_s = 3},
      {with_stops(urban(), 0.8, 15, 75)}, "urban", 4);
  add({.number = 3,
       .distance_m = 37000,
       .odometry_points = 85226,
       .fixes = 3354,
       .gyro_bias_radps = 0.000248,
       .bias_m = {-0.563, 0.583},
       .fast_sigma_m = 0.901,
       .jitter_m = 0.305,
       .bursts_per_minute = 2,
       .burst_size_m = 12.8,
       .burst_duration_s = 1.5},
      {with_stops(rural(), 0.6, 10, 70), with_share(highway(), 0.3), with_share(congested(), 0.5)},
      "highway, rural", 1);
  add({.number = 4,
       .distance_m = 25000,
       .odometry_points = 68351,
       .fixes = 2716,
       .gyro_bias_radps = 0.000278,
       .bias_m = {0.786, 0.688},
       .fast_sigma_m = 0.639,
       .jitter_m = 0.119,
       .bursts_per_minute = 3,
       .burst_size_m = 1.96,
       .burst_duration_s = 3},
      {with_stops(rural(), 0.8, 20, 120)}, "rural", 5);
  add({.number = 5,
       .distance_m = 19000,
       .odometry_points = 61479,
       .fixes = 2458,
       .gyro_bias_radps = 0.00038,
       .bias_m = {0.517, -0.415},
       .fast_sigma_m = 0.694,
       .jitter_m = 0.0995,
       .bursts_per_minute = 0.8,
       .burst_size_m = 4.9,
       .burst_duration_s = 1.5},
      {with_stops(urban(), 0.35, 5, 30)}, "urban", 6);
  add({.number = 6,
       .distance_m = 24000,
       .odometry_points = 39685,
       .fixes = 1585,
       .gyro_bias_radps = 0.000317,
       .bias_m = {0.179, -0.310},
       .fast_sigma_m = 0.663,
       .jitter_m = 0.119,
       .bursts_per_minute = 3,
       .burst_size_m = 1.17,
       .burst_duration_s = 3},
      {with_share(highway(), 0.5), with_share(congested(), 0.5)}, "highway", 3);
  add({.number = 7,
       .distance_m = 26000,
       .odometry_points = 82313,
       .fixes = 3281,
       .gyro_bias_radps = 0.000255,
       .bias_m = {-0.619, 0.517},
       .fast_sigma_m = 0.74,
       .jitter_m = 0.0705,
       .bursts_per_minute = 2,
       .burst_size_m = 3.23,
       .burst_duration_s = 3},
      {with_stops(rural(), 0.9, 30, 150)}, "rural", 5);
  add({.number = 8,
       .distance_m = 25000,
       .odometry_points = 104949,
       .fixes = 4188,
       .gyro_bias_radps = 0.000183,
       .bias_m = {0.579, 0.340},
       .fast_sigma_m = 0.683,
       .jitter_m = 0.112,
       .bursts_per_minute = 1,
       .burst_size_m = 7.94,
       .burst_duration_s = 2},
      {with_stops(rural(), 0.9, 60, 200)}, "rural", 5);
  return all;
}

/// Gives a receiver errors with the given position rms: mostly the fast part, over seconds, without
/// bursts. The stated accuracy is true.
GnssRecipe receiver(std::string name, double rate_hz, double position_rms_m, double tau_s) {
  const double per_axis = position_rms_m / std::numbers::sqrt2;
  GnssRecipe gnss{.name = std::move(name), .rate_hz = rate_hz};
  gnss.bias_sigma_m = 0.3 * per_axis;
  gnss.jitter_m = 0.3 * per_axis;
  gnss.fast_sigma_m = std::sqrt(1 - 2 * 0.3 * 0.3) * per_axis;
  gnss.fast_tau_s = tau_s;
  gnss.bursts_per_minute = 0;
  gnss.stated_95_m = 2 * per_axis;
  return gnss;
}

/// Returns a drive of twenty minutes over roads of all kinds.
SimulationRecipe twenty_minutes(std::string name, OdometryRecipe odometry) {
  return {.name = std::move(name),
          .duration_s = 1200,
          .roads = {urban(), rural(), highway()},
          .odometry = std::move(odometry)};
}

OdometryRecipe ordinary_wheels() {
  OdometryRecipe wheels{.name = "wheels"};
  wheels.speed_scale_sigma = 0.006;
  wheels.gyro_bias_sigma_radps = 5e-4;
  return wheels;
}

/// Sets the share of epochs with a fix.
GnssRecipe with_availability(GnssRecipe gnss, double share, double outage_s, double duration_s) {
  gnss.missing_epochs =
      static_cast<int>(std::lround((1 - share) * gnss.rate_hz * (duration_s - gnss.first_s)));
  gnss.outage_s = outage_s;
  return gnss;
}

GnssRecipe mounted(GnssRecipe gnss, double first_s, const Eigen::Vector2d& antenna_m) {
  gnss.first_s = first_s;
  gnss.antenna_m = antenna_m;
  return gnss;
}

/// Availability and position rms are those of the absolute sources that a published framework for
/// the fusion of any number of sources was tried with.
SimulationRecipe three_absolute() {
  SimulationRecipe recipe = twenty_minutes("three-absolute", ordinary_wheels());
  const double duration_s = recipe.duration_s;
  recipe.gnss = with_availability(mounted(receiver("front", 1, 1.06, 4), 1, {2.6, 0}), 0.67, 20, duration_s);
  recipe.further_gnss = {
      mounted(receiver("rear", 10, 1.23, 4), 1.02, {-0.8, 0}),
      with_availability(mounted(receiver("roof", 5, 0.28, 4), 1.06, {0.9, 0.4}), 0.98, 8, duration_s)};
  return recipe;
}

/// The wheels read a wrong scale and turn poorly. The visual odometry turns well.
SimulationRecipe two_odometries() {
  OdometryRecipe wheels{.name = "wheels", .rate_hz = 50};
  wheels.speed_scale = 0.02;
  wheels.speed_scale_sigma = 0.005;
  wheels.gyro_bias_sigma_radps = 3e-3;
  wheels.yaw_rate_noise_radps = 0.02 * std::sqrt(wheels.rate_hz);
  wheels.silent_share = 0.1;
  OdometryRecipe visual{.name = "visual", .rate_hz = 10, .first_s = 0.06};
  visual.speed_scale_sigma = 0.01;
  visual.speed_noise_mps = 0.05;
  visual.speed_step_mps = 0;
  visual.gyro_bias_sigma_radps = 1e-4;
  visual.yaw_rate_noise_radps = 5e-4 * std::sqrt(visual.rate_hz);
  visual.yaw_rate_step_radps = 0;
  visual.silent_share = 0.15;

  SimulationRecipe recipe = twenty_minutes("two-odometries", std::move(wheels));
  recipe.further_odometry = {std::move(visual)};
  recipe.gnss.fast_sigma_m = 1.5;
  recipe.gnss.bias_sigma_m = 1;
  recipe.gnss.jitter_m = 0.3;
  recipe.gnss.stated_95_m = 3;
  return recipe;
}

/// Both antennas see the same satellites.
SimulationRecipe correlated_receivers() {
  SimulationRecipe recipe = twenty_minutes("correlated-receivers", ordinary_wheels());
  recipe.gnss = mounted(receiver("rear", 1, 2, 30), 1, {-0.8, 0});
  recipe.gnss.common_share = 0.8;
  recipe.further_gnss = {mounted(receiver("front", 1, 2, 30), 1.5, {2.6, 0})};
  recipe.further_gnss.front().common_share = 0.8;
  return recipe;
}

/// Returns one of the values, each as likely.
template <typename T>
T one_of(std::initializer_list<T> values, RandomStream& random) {
  const auto at = static_cast<std::size_t>(random.uniform() * static_cast<double>(values.size()));
  return *(values.begin() + at);
}

/// Uniform in the logarithm.
double scattered(double low, double high, RandomStream& random) {
  return low * std::pow(high / low, random.uniform());
}

OdometryRecipe varied_odometry(RandomStream& random) {
  OdometryRecipe odometry;
  odometry.rate_hz = one_of({1.0, 2.0, 5.0, 10.0, 25.0, 50.0, 100.0}, random);
  odometry.speed_scale_sigma = scattered(0.002, 0.03, random);
  odometry.speed_noise_mps = scattered(0.01, 0.1, random);
  odometry.gyro_bias_sigma_radps = scattered(1e-4, 5e-3, random);
  // The heading walks by this in the root of a second, at any rate.
  odometry.yaw_rate_noise_radps = scattered(3e-4, 0.033, random) * std::sqrt(odometry.rate_hz);
  return odometry;
}

GnssRecipe varied_gnss(double duration_s, RandomStream& random) {
  GnssRecipe gnss;
  gnss.fast_sigma_m = one_of({0.01, 0.3, 1.0, 2.0, 4.0, 8.0}, random);
  gnss.fast_tau_s = scattered(8, 120, random);
  gnss.smoothing_s = one_of({0.0, 4.0}, random);
  gnss.jitter_m = scattered(0.1, 1, random) * gnss.fast_sigma_m;
  gnss.bias_sigma_m = 0.7 * gnss.fast_sigma_m;
  gnss.bursts_per_minute = one_of({0.0, 1.0, 3.0}, random);
  gnss.burst_size_m = 5 * gnss.fast_sigma_m;
  gnss.stated_95_m = 2 * gnss.fast_sigma_m * scattered(1.0 / 3, 3, random);
  gnss.stated_step_m = 0.001;
  gnss.delay_s = one_of({0.0, 1.0, 1.0}, random) * 0.01 * std::round(random.uniform(-100, 100));
  gnss.missing_epochs = static_cast<int>(one_of({0.0, 0.05, 0.2}, random) * duration_s);
  gnss.outage_s = scattered(2, 60, random);
  return gnss;
}

}  // namespace

SimulationRecipe varied(const SimulationRecipe& recipe, std::uint64_t seed) {
  RandomStream random(seed, kVariedStream);
  SimulationRecipe drawn = recipe;
  drawn.varied = false;
  drawn.roads = {one_of({highway(), congested(), urban(), rural()}, random)};
  drawn.odometry = varied_odometry(random);
  drawn.gnss = varied_gnss(recipe.duration_s, random);
  return drawn;
}

const std::vector<SimulationPreset>& simulation_presets() {
  static const std::vector<SimulationPreset> presets = [] {
    std::vector<SimulationPreset> all;
    all.push_back({"highway", "10 minutes of motorway", consistency("highway", {highway()}, 1.2), 1});
    all.push_back(
        {"urban", "10 minutes of streets, half of them canyons", consistency("urban", {urban()}, 3), 1});
    all.push_back({"rural", "10 minutes of country roads", consistency("rural", {rural()}, 1.5), 1});
    all.push_back({"mixed", "10 minutes: streets, country roads, motorway",
                   consistency("mixed", {urban(), rural(), highway()}, 2), 1});
    all.push_back({"varied",
                   "10 minutes whose road, sensors and delay the seed draws",
                   {.name = "varied", .duration_s = 600, .roads = {rural()}, .varied = true},
                   1});
    for (SimulationPreset& preset : paper_presets()) all.push_back(std::move(preset));
    all.push_back({"three-absolute",
                   "20 minutes, three receivers: 67, 100 and 98 % of the time, 1.06, 1.23, 0.28 m",
                   three_absolute(), 1});
    all.push_back({"two-odometries", "20 minutes, wheels and visual odometry, each silent at times",
                   two_odometries(), 1});
    all.push_back({"correlated-receivers",
                   "20 minutes, two receivers with 80 % of their lasting errors in common",
                   correlated_receivers(), 1});
    return all;
  }();
  return presets;
}

const SimulationPreset& simulation_preset(std::string_view name) {
  std::vector<std::string_view> names;
  for (const SimulationPreset& preset : simulation_presets()) {
    if (preset.name == name) return preset;
    names.push_back(preset.name);
  }
  throw UsageError("unknown preset '" + std::string(name) + "'" + suggestion(name, names));
}

}  // namespace waymark::simulation
