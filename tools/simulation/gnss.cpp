#include <algorithm>
#include <cmath>
#include <numbers>

#include <waymark/tools/simulation/random.hpp>
#include <waymark/tools/simulation/sensors.hpp>
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

}  // namespace

std::vector<bool> draw_outages(std::size_t epochs, int missing, double mean_length, std::uint64_t seed) {
  std::vector<bool> out(epochs, false);
  RandomStream random(seed, kGnssOutageStream);
  int left = std::min(missing, static_cast<int>(epochs));
  while (left > 0) {
    auto at = static_cast<std::size_t>(random.uniform() * static_cast<double>(epochs));
    const auto length = static_cast<int>(std::ceil(mean_length * random.exponential()));
    for (int i = 0; i < length && at < epochs && left > 0; ++i, ++at) {
      if (out[at]) continue;
      out[at] = true;
      --left;
    }
  }
  return out;
}

std::vector<Eigen::Vector2d> draw_bursts(const std::vector<bool>& canyon, const GnssRecipe& recipe,
                                         std::uint64_t seed) {
  std::vector<Eigen::Vector2d> sum(canyon.size(), Eigen::Vector2d::Zero());
  if (recipe.bursts_per_minute <= 0) return sum;
  RandomStream random(seed, kGnssBurstStream);
  const double mean_gap_s = 60 / recipe.bursts_per_minute;
  double until_next_s = mean_gap_s * random.exponential();  // of time spent in canyons
  for (std::size_t epoch = 0; epoch < canyon.size(); ++epoch) {
    if (!canyon[epoch]) continue;
    until_next_s -= 1;
    while (until_next_s < 0) {
      // into the second before this epoch
      const double begin_s = std::clamp(1 + until_next_s, 0.0, 1.0);
      const double size = recipe.burst_size_m * random.exponential();
      const double direction = 2 * std::numbers::pi * random.uniform();
      const double duration = recipe.burst_duration_s * random.exponential();
      const Eigen::Vector2d peak = turned(direction, {size, 0});
      const double reached = 1 - std::exp(-duration / recipe.burst_rise_s);
      for (std::size_t later = epoch; later < canyon.size(); ++later) {
        const double t = static_cast<double>(later - epoch) + 1 - begin_s;
        const double shape = t < duration ? 1 - std::exp(-t / recipe.burst_rise_s)
                                          : reached * std::exp(-(t - duration) / recipe.burst_decay_s);
        if (t > duration && shape < 1e-3) break;
        sum[later] += shape * peak;
      }
      until_next_s += mean_gap_s * random.exponential();
    }
  }
  return sum;
}

void sense_gnss(std::span<const PlacedState> epochs, const drive::Projection& projection,
                SimulatedDrive& drive) {
  const GnssRecipe& recipe = drive.recipe.gnss;
  RandomStream bias_random(drive.seed, kGnssBiasStream);
  RandomStream fast_random(drive.seed, kGnssFastStream);
  RandomStream jitter_random(drive.seed, kGnssJitterStream);
  RandomStream stated_random(drive.seed, kGnssStatedStream);
  RandomStream velocity_random(drive.seed, kGnssVelocityStream);
  SmoothedGaussMarkov fast_east(recipe.fast_tau_s, recipe.smoothing_s, 1);
  SmoothedGaussMarkov fast_north(recipe.fast_tau_s, recipe.smoothing_s, 1);
  GaussMarkov up(recipe.fast_tau_s);
  GaussMarkov stated(kStatedTau);
  drive.gnss_bias_m = Eigen::Vector2d(recipe.bias_east_m, recipe.bias_north_m) +
                      recipe.bias_sigma_m * normal_pair(bias_random);
  std::vector<bool> canyon;
  for (const PlacedState& state : epochs) canyon.push_back(state.canyon);
  const std::vector<Eigen::Vector2d> bursts = draw_bursts(canyon, recipe, drive.seed);
  const std::vector<bool> out =
      draw_outages(epochs.size(), recipe.missing_epochs, recipe.outage_s, drive.seed);

  for (std::size_t i = 0; i < epochs.size(); ++i) {
    // Errors are drawn for missing epochs too, because they go on without fixes.
    SimulatedFix simulated;
    const double east = fast_east.next(fast_random);
    simulated.parts.fast = recipe.fast_sigma_m * Eigen::Vector2d(east, fast_north.next(fast_random));
    simulated.parts.jitter = recipe.jitter_m * normal_pair(jitter_random);
    simulated.parts.burst = bursts[i];
    const double variation = 1 + recipe.stated_variation * stated.next(1, stated_random);
    const double height = kHeight + kHeightNoise * up.next(1, stated_random);
    const Eigen::Vector2d velocity_noise = kVelocityNoise * normal_pair(velocity_random);
    if (out[i]) continue;

    const Eigen::Vector2d error =
        drive.gnss_bias_m + simulated.parts.fast + simulated.parts.jitter + simulated.parts.burst;
    const PlacedState& state = epochs[i];
    const drive::GridPoint grid = projection.to_grid(projection.to_geodetic(state.pose.head<2>()));
    const drive::GeodeticPoint place =
        projection.to_geodetic(state.pose.head<2>() + grid.scale * turned(grid.convergence_rad, error));
    GeodeticFix& fix = simulated.fix;
    fix.stamp = state.stamp;
    fix.latitude_deg = place.latitude_deg;
    fix.longitude_deg = place.longitude_deg;
    fix.height_m = height;
    set_velocity(turned(state.pose[2] - grid.convergence_rad, {state.speed_mps, 0}) + velocity_noise, fix);
    const double admitted = recipe.burst_admitted * simulated.parts.burst.norm();
    const double base = recipe.stated_95_m * std::max(0.3, variation) + admitted;
    simulated.epx_m = rounded_up(base, recipe.stated_step_m);
    simulated.epy_m = rounded_up(kNorthOverEast * base, recipe.stated_step_m);
    simulated.epv_m = rounded_up(kUpOverEast * base, recipe.stated_step_m);
    fix.covariance_en = Eigen::Vector2d(simulated.epx_m / 2, simulated.epy_m / 2).cwiseAbs2().asDiagonal();
    drive.fixes.push_back(simulated);
  }
}

void sense_truth(std::span<const PlacedState> states, const drive::Projection& projection,
                 SimulatedDrive& drive) {
  const TruthRecipe& recipe = drive.recipe.truth;
  RandomStream random(drive.seed, kTruthStream);
  for (const PlacedState& state : states) {
    drive.poses.push_back({state.stamp, state.pose});
    const Eigen::Vector2d position = state.pose.head<2>() + recipe.position_noise_m * normal_pair(random);
    const double heading = state.pose[2] + recipe.heading_noise_rad * random.normal();
    const drive::GeodeticPoint place = projection.to_geodetic(position);
    const double convergence = projection.to_grid(place).convergence_rad;
    drive.truth.push_back({state.stamp, place.latitude_deg, place.longitude_deg, kHeight,
                           std::remainder(heading - convergence, 2 * std::numbers::pi)});
  }
}

}  // namespace waymark::simulation
