#include <waymark/tools/simulation/recipe.hpp>

#include <cmath>
#include <set>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/simulation/road.hpp>

namespace waymark::simulation {
namespace {

void require(bool fulfilled, const char* parameter, double value, const char* rule) {
  if (!fulfilled)
    throw UsageError(fmt::format("simulation recipe: {} must be {}, got {}", parameter, rule, value));
}

void require_positive(const char* parameter, double value) {
  require(value > 0 && std::isfinite(value), parameter, value, "a number above 0");
}

void require_not_negative(const char* parameter, double value) {
  require(value >= 0 && std::isfinite(value), parameter, value, "a number not below 0");
}

void require_probability(const char* parameter, double value) {
  require(value >= 0 && value <= 1, parameter, value, "in [0, 1]");
}

void require_range(const char* parameter, double low, double high) {
  require_not_negative(parameter, low);
  require(high >= low && std::isfinite(high), parameter, high, "a range whose end is not below its start");
}

/// Sensors are sampled at ticks of the simulation.
void require_rate(const char* parameter, double rate_hz) {
  require_positive(parameter, rate_hz);
  const double ticks = kTicksPerSecond / rate_hz;
  require(ticks >= 1 && ticks == std::round(ticks), parameter, rate_hz, "a divisor of 100 Hz");
}

void require_tick(const char* parameter, double value_s) {
  require_not_negative(parameter, value_s);
  const double ticks = value_s * kTicksPerSecond;
  require(std::abs(ticks - std::round(ticks)) < 1e-6, parameter, value_s, "a multiple of 0.01 s");
}

void check(const RoadRecipe& road) {
  require_positive("road.share", road.share);
  require_positive("road.cruise_min_mps", road.cruise_min_mps);
  require_range("road.cruise_max_mps", road.cruise_min_mps, road.cruise_max_mps);
  require_not_negative("road.speed_wander", road.speed_wander);
  require_positive("road.acceleration_mps2", road.acceleration_mps2);
  require_positive("road.deceleration_mps2", road.deceleration_mps2);
  require_positive("road.lateral_acceleration_mps2", road.lateral_acceleration_mps2);
  require_positive("road.leg_min_m", road.leg_min_m);
  require_range("road.leg_max_m", road.leg_min_m, road.leg_max_m);
  require_positive("road.straight_m", road.straight_m);
  require_not_negative("road.bend_sigma_deg", road.bend_sigma_deg);
  require_positive("road.bend_radius_min_m", road.bend_radius_min_m);
  require_range("road.bend_radius_max_m", road.bend_radius_min_m, road.bend_radius_max_m);
  require_probability("road.corner_probability", road.corner_probability);
  require_positive("road.corner_radius_m", road.corner_radius_m);
  require_probability("road.stop_probability", road.stop_probability);
  require_positive("road.stop_min_s", road.stop_min_s);
  require_range("road.stop_max_s", road.stop_min_s, road.stop_max_s);
  require_probability("road.canyon_probability", road.canyon_probability);
}

void check(const OdometryRecipe& odometry) {
  require_rate("odometry.rate_hz", odometry.rate_hz);
  require_tick("odometry.first_s", odometry.first_s);
  require(odometry.speed_scale > -1, "odometry.speed_scale", odometry.speed_scale, "above -1");
  require_not_negative("odometry.speed_scale_sigma", odometry.speed_scale_sigma);
  require_not_negative("odometry.speed_noise_mps", odometry.speed_noise_mps);
  require_not_negative("odometry.speed_step_mps", odometry.speed_step_mps);
  require(std::isfinite(odometry.gyro_bias_radps), "odometry.gyro_bias_radps", odometry.gyro_bias_radps,
          "finite");
  require_not_negative("odometry.gyro_bias_sigma_radps", odometry.gyro_bias_sigma_radps);
  require_not_negative("odometry.gyro_bias_walk_radps_sqrts", odometry.gyro_bias_walk_radps_sqrts);
  require_not_negative("odometry.yaw_rate_noise_radps", odometry.yaw_rate_noise_radps);
  require_not_negative("odometry.yaw_rate_step_radps", odometry.yaw_rate_step_radps);
  require_probability("odometry.silent_share", odometry.silent_share);
  require_positive("odometry.outage_s", odometry.outage_s);
}

void check(const GnssRecipe& gnss) {
  require_rate("gnss.rate_hz", gnss.rate_hz);
  require_tick("gnss.first_s", gnss.first_s);
  require(gnss.antenna_m.allFinite(), "gnss.antenna_m", gnss.antenna_m.norm(), "finite");
  require(std::isfinite(gnss.bias_east_m), "gnss.bias_east_m", gnss.bias_east_m, "finite");
  require(std::isfinite(gnss.bias_north_m), "gnss.bias_north_m", gnss.bias_north_m, "finite");
  require_not_negative("gnss.bias_sigma_m", gnss.bias_sigma_m);
  require_not_negative("gnss.fast_sigma_m", gnss.fast_sigma_m);
  require_positive("gnss.fast_tau_s", gnss.fast_tau_s);
  require_not_negative("gnss.smoothing_s", gnss.smoothing_s);
  require_not_negative("gnss.jitter_m", gnss.jitter_m);
  require_probability("gnss.common_share", gnss.common_share);
  require_not_negative("gnss.bursts_per_minute", gnss.bursts_per_minute);
  require_not_negative("gnss.burst_size_m", gnss.burst_size_m);
  require_positive("gnss.burst_duration_s", gnss.burst_duration_s);
  require_positive("gnss.burst_rise_s", gnss.burst_rise_s);
  require_positive("gnss.burst_decay_s", gnss.burst_decay_s);
  require_not_negative("gnss.burst_admitted", gnss.burst_admitted);
  require(std::abs(gnss.delay_s) <= 10, "gnss.delay_s", gnss.delay_s, "in [-10, 10]");
  require_not_negative("gnss.missing_epochs", gnss.missing_epochs);
  require_positive("gnss.outage_s", gnss.outage_s);
  require_positive("gnss.stated_95_m", gnss.stated_95_m);
  require_not_negative("gnss.stated_variation", gnss.stated_variation);
  require_not_negative("gnss.stated_step_m", gnss.stated_step_m);
}

/// Names of sources are names of files too.
void check_names(const SimulationRecipe& recipe) {
  std::set<std::string> names = {"drive", "truth"};
  const auto check_name = [&names](const std::string& name) {
    if (!names.insert(name).second || name.empty() ||
        name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") != std::string::npos)
      throw UsageError(
          "simulation recipe: the name of a source must be lower-case, of its own and not 'drive' "
          "or 'truth', got '" +
          name + "'");
  };
  for (const OdometryRecipe& odometry : recipe.all_odometry()) check_name(odometry.name);
  for (const GnssRecipe& gnss : recipe.all_gnss()) check_name(gnss.name);
}

}  // namespace

std::vector<OdometryRecipe> SimulationRecipe::all_odometry() const {
  std::vector<OdometryRecipe> all = {odometry};
  all.insert(all.end(), further_odometry.begin(), further_odometry.end());
  return all;
}

std::vector<GnssRecipe> SimulationRecipe::all_gnss() const {
  std::vector<GnssRecipe> all = {gnss};
  all.insert(all.end(), further_gnss.begin(), further_gnss.end());
  return all;
}

SimulationRecipe with_duration(SimulationRecipe recipe, double duration_s) {
  const double factor = duration_s / recipe.duration_s;
  recipe.duration_s = duration_s;
  recipe.distance_m *= factor;
  const auto scale = [factor](GnssRecipe& gnss) {
    gnss.missing_epochs = static_cast<int>(std::lround(factor * gnss.missing_epochs));
  };
  scale(recipe.gnss);
  for (GnssRecipe& gnss : recipe.further_gnss) scale(gnss);
  return recipe;
}

void check(const SimulationRecipe& recipe) {
  constexpr double kLeastDuration = 10;
  constexpr double kLongestDuration = 86400;
  require(recipe.duration_s >= kLeastDuration && recipe.duration_s <= kLongestDuration, "duration_s",
          recipe.duration_s, "from 10 s to a day");
  require_not_negative("distance_m", recipe.distance_m);
  if (recipe.roads.empty()) throw UsageError("simulation recipe: it has no road");
  for (const RoadRecipe& road : recipe.roads) check(road);
  for (const OdometryRecipe& odometry : recipe.all_odometry()) check(odometry);
  for (const GnssRecipe& gnss : recipe.all_gnss()) check(gnss);
  check_names(recipe);
  require_rate("truth.rate_hz", recipe.truth.rate_hz);
  require_not_negative("truth.position_noise_m", recipe.truth.position_noise_m);
  require_not_negative("truth.heading_noise_rad", recipe.truth.heading_noise_rad);
}

}  // namespace waymark::simulation
