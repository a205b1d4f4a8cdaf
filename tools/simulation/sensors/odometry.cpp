#include <algorithm>
#include <cmath>

#include <waymark/tools/simulation/random.hpp>
#include <waymark/tools/simulation/sensors/sensors.hpp>
#include <waymark/tools/simulation/streams.hpp>

namespace waymark::simulation {
namespace {

double quantised(double value, double step) {
  return step > 0 ? step * std::round(value / step) : value;
}

std::vector<std::size_t> reading_ticks(std::size_t count, const OdometryRecipe& recipe) {
  const auto step = static_cast<std::size_t>(std::lround(kTicksPerSecond / recipe.rate_hz));
  std::vector<std::size_t> ticks;
  for (auto tick = static_cast<std::size_t>(std::lround(recipe.first_s * kTicksPerSecond)); tick < count;
       tick += step)
    ticks.push_back(tick);
  return ticks;
}

std::vector<bool> silent_readings(std::size_t count, const OdometryRecipe& recipe,
                                  const SourceStreams& streams) {
  const auto silent = static_cast<int>(std::lround(recipe.silent_share * static_cast<double>(count)));
  return draw_outages(count, silent, recipe.outage_s * recipe.rate_hz, streams.of(kOdometryOutageStream));
}

}  // namespace

SimulatedOdometry sense_odometry(const std::vector<DrivenState>& states, Stamp start,
                                 const OdometryRecipe& recipe, const SourceStreams& streams) {
  RandomStream calibration = streams.of(kOdometryCalibrationStream);
  RandomStream speed_noise = streams.of(kSpeedStream);
  RandomStream yaw_rate_noise = streams.of(kYawRateStream);
  SimulatedOdometry odometry;
  odometry.name = recipe.name;
  odometry.speed_scale = recipe.speed_scale + recipe.speed_scale_sigma * calibration.normal();
  odometry.gyro_bias_radps = recipe.gyro_bias_radps + recipe.gyro_bias_sigma_radps * calibration.normal();

  const std::vector<std::size_t> ticks = reading_ticks(states.size(), recipe);
  const std::vector<bool> silent = silent_readings(ticks.size(), recipe, streams);
  const double walk = recipe.gyro_bias_walk_radps_sqrts / std::sqrt(recipe.rate_hz);
  double bias = odometry.gyro_bias_radps;
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const DrivenState& state = states[ticks[i]];
    OdometrySample sample;
    sample.stamp = {start.nanoseconds +
                    static_cast<std::int64_t>(ticks[i]) * (1'000'000'000 / kTicksPerSecond)};
    const double speed =
        (1 + odometry.speed_scale) * state.speed_mps + recipe.speed_noise_mps * speed_noise.normal();
    // Wheel pulses have no sign, and a standing wheel gives none.
    if (state.speed_mps > 0) sample.speed_mps = std::max(0.0, quantised(speed, recipe.speed_step_mps));
    sample.yaw_rate_radps =
        quantised(state.yaw_rate_radps + bias + recipe.yaw_rate_noise_radps * yaw_rate_noise.normal(),
                  recipe.yaw_rate_step_radps);
    if (!silent[i]) odometry.samples.push_back(sample);
    bias += walk * calibration.normal();
  }
  return odometry;
}

}  // namespace waymark::simulation
