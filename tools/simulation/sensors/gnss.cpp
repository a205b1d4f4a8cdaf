#include <algorithm>
#include <cmath>
#include <numbers>

#include <waymark/tools/simulation/random.hpp>
#include <waymark/tools/simulation/sensors/sensors.hpp>
#include <waymark/tools/simulation/streams.hpp>

namespace waymark::simulation {
namespace {

constexpr double kNorthOverEast = 1.15;  // stated errors: satellites are in the south
constexpr double kUpOverEast = 2.2;
constexpr double kStatedTau = 120;         // s
constexpr double kVelocityNoise = 0.05;    // m/s per axis, Doppler
constexpr double kLeastCourseSpeed = 0.5;  // m/s; at lower speeds the receiver gives no track
constexpr double kHeight = 75;             // m
constexpr double kHeightNoise = 1.5;       // m, correlated like the fast part

Eigen::Vector2d normal_pair(RandomStream& random) {
  const double east = random.normal();
  return {east, random.normal()};
}

Eigen::Vector2d turned(double angle, const Eigen::Vector2d& v) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {c * v[0] - s * v[1], s * v[0] + c * v[1]};
}

double rounded_up(double value, double step) {
  return step > 0 ? std::max(step, step * std::round(value / step)) : value;
}

/// Sets course and speed over ground from a velocity on true axes.
void set_velocity(const Eigen::Vector2d& velocity_en, GeodeticFix& fix) {
  fix.speed_mps = velocity_en.norm();
  if (*fix.speed_mps < kLeastCourseSpeed) return;
  const double course = std::atan2(velocity_en[0], velocity_en[1]);
  fix.course_rad = course < 0 ? course + 2 * std::numbers::pi : course;
}

LastingErrors lasting_errors(std::span<const PlacedState> epochs, const GnssRecipe& recipe,
                             const LastingErrors& common, const SourceStreams& streams) {
  const LastingErrors own = draw_lasting_errors(epochs.size(), 1 / recipe.rate_hz, recipe,
                                                streams.of(kGnssBiasStream), streams.of(kGnssFastStream));
  if (recipe.common_share == 0) return own;
  std::vector<std::size_t> ticks;
  for (const PlacedState& state : epochs) ticks.push_back(state.tick);
  return with_common(own, common, recipe.common_share, ticks);
}

std::vector<Eigen::Vector2d> bursts_at(std::span<const PlacedState> epochs, const GnssRecipe& recipe,
                                       const SourceStreams& streams) {
  std::vector<bool> canyon;
  for (const PlacedState& state : epochs) canyon.push_back(state.canyon);
  return draw_bursts(canyon, recipe, streams.of(kGnssBurstStream));
}

/// Sets stamp, position, course and speed of a fix: those of the antenna, with its errors.
void place_fix(const PlacedState& state, const drive::Projection& projection,
               const Eigen::Vector2d& antenna_m, const Eigen::Vector2d& bias_m,
               const Eigen::Vector2d& velocity_noise, SimulatedFix& simulated) {
  const Eigen::Vector2d error =
      bias_m + simulated.parts.fast + simulated.parts.jitter + simulated.parts.burst;
  const GridPoint grid = projection.to_grid(projection.to_geodetic(state.pose.head<2>()));
  const Eigen::Vector2d from_body = turned(state.pose[2], antenna_m) + turned(grid.convergence_rad, error);
  const GeodeticPoint place = projection.to_geodetic(state.pose.head<2>() + grid.scale * from_body);
  simulated.fix.stamp = state.stamp;
  simulated.fix.latitude_deg = place.latitude_deg;
  simulated.fix.longitude_deg = place.longitude_deg;
  const Eigen::Vector2d velocity_body(state.speed_mps - state.yaw_rate_radps * antenna_m[1],
                                      state.yaw_rate_radps * antenna_m[0]);
  set_velocity(turned(state.pose[2] - grid.convergence_rad, velocity_body) + velocity_noise, simulated.fix);
}

/// Sets the accuracy that the receiver states. @param variation factor on its mean
void state_accuracy(const GnssRecipe& recipe, double variation, SimulatedFix& simulated) {
  const double admitted = recipe.burst_admitted * simulated.parts.burst.norm();
  const double base = recipe.stated_95_m * std::max(0.3, variation) + admitted;
  simulated.epx_m = rounded_up(base, recipe.stated_step_m);
  simulated.epy_m = rounded_up(kNorthOverEast * base, recipe.stated_step_m);
  simulated.epv_m = rounded_up(kUpOverEast * base, recipe.stated_step_m);
  simulated.fix.covariance_en =
      Eigen::Vector2d(simulated.epx_m / 2, simulated.epy_m / 2).cwiseAbs2().asDiagonal();
}

}  // namespace

SimulatedGnss sense_gnss(std::span<const PlacedState> epochs, const drive::Projection& projection,
                         const GnssRecipe& recipe, const LastingErrors& common,
                         const SourceStreams& streams) {
  const double interval_s = 1 / recipe.rate_hz;
  RandomStream jitter_random = streams.of(kGnssJitterStream);
  RandomStream stated_random = streams.of(kGnssStatedStream);
  RandomStream velocity_random = streams.of(kGnssVelocityStream);
  GaussMarkov up(recipe.fast_tau_s);
  GaussMarkov stated(kStatedTau);
  const LastingErrors lasting = lasting_errors(epochs, recipe, common, streams);
  const std::vector<Eigen::Vector2d> bursts = bursts_at(epochs, recipe, streams);
  const std::vector<bool> out = draw_outages(epochs.size(), recipe.missing_epochs,
                                             recipe.outage_s * recipe.rate_hz, streams.of(kGnssOutageStream));
  SimulatedGnss gnss;
  gnss.name = recipe.name;
  gnss.bias_m = Eigen::Vector2d(recipe.bias_east_m, recipe.bias_north_m) + recipe.bias_sigma_m * lasting.bias;

  for (std::size_t i = 0; i < epochs.size(); ++i) {
    // Errors are drawn for missing epochs too, because they go on without fixes.
    SimulatedFix simulated;
    simulated.parts.fast = recipe.fast_sigma_m * lasting.fast[i];
    simulated.parts.jitter = recipe.jitter_m * normal_pair(jitter_random);
    simulated.parts.burst = bursts[i];
    const double variation = 1 + recipe.stated_variation * stated.next(interval_s, stated_random);
    const double height = kHeight + kHeightNoise * up.next(interval_s, stated_random);
    const Eigen::Vector2d velocity_noise = kVelocityNoise * normal_pair(velocity_random);
    if (out[i]) continue;

    place_fix(epochs[i], projection, recipe.antenna_m, gnss.bias_m, velocity_noise, simulated);
    simulated.fix.height_m = height;
    state_accuracy(recipe, variation, simulated);
    gnss.fixes.push_back(simulated);
  }
  return gnss;
}

void sense_truth(std::span<const PlacedState> states, const drive::Projection& projection,
                 SimulatedDrive& drive) {
  const TruthRecipe& recipe = drive.recipe.truth;
  RandomStream random(drive.seed, kTruthStream);
  for (const PlacedState& state : states) {
    drive.poses.push_back({state.stamp, state.pose});
    const Eigen::Vector2d position = state.pose.head<2>() + recipe.position_noise_m * normal_pair(random);
    const double heading = state.pose[2] + recipe.heading_noise_rad * random.normal();
    const GeodeticPoint place = projection.to_geodetic(position);
    const double convergence = projection.to_grid(place).convergence_rad;
    drive.truth.push_back({state.stamp, place.latitude_deg, place.longitude_deg, kHeight,
                           std::remainder(heading - convergence, 2 * std::numbers::pi)});
  }
}

}  // namespace waymark::simulation
