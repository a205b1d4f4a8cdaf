#include <algorithm>
#include <cmath>

#include <waymark/tools/simulation/random.hpp>
#include <waymark/tools/simulation/sensors.hpp>
#include <waymark/tools/simulation/streams.hpp>

namespace waymark::simulation {
namespace {

double quantised(double value, double step) {
  return step > 0 ? step * std::round(value / step) : value;
}

}  // namespace

void sense_odometry(const std::vector<DrivenState>& states, Stamp start, SimulatedDrive& drive) {
  const OdometryRecipe& recipe = drive.recipe.odometry;
  RandomStream calibration(drive.seed, kOdometryCalibrationStream);
  RandomStream speed_noise(drive.seed, kSpeedStream);
  RandomStream yaw_rate_noise(drive.seed, kYawRateStream);
  drive.speed_scale = recipe.speed_scale + recipe.speed_scale_sigma * calibration.normal();
  drive.gyro_bias_radps = recipe.gyro_bias_radps + recipe.gyro_bias_sigma_radps * calibration.normal();

  const auto ticks = static_cast<std::int64_t>(std::lround(kTicksPerSecond / recipe.rate_hz));
  const double walk = recipe.gyro_bias_walk_radps_sqrts / std::sqrt(recipe.rate_hz);
  double bias = drive.gyro_bias_radps;
  for (std::size_t t = 1; t < states.size(); t += static_cast<std::size_t>(ticks)) {
    const DrivenState& state = states[t];
    OdometrySample sample;
    sample.stamp = {start.nanoseconds + static_cast<std::int64_t>(t) * (1'000'000'000 / kTicksPerSecond)};
    const double speed =
        (1 + drive.speed_scale) * state.speed_mps + recipe.speed_noise_mps * speed_noise.normal();
    // Wheel pulses have no sign, and a standing wheel gives none.
    if (state.speed_mps > 0) sample.speed_mps = std::max(0.0, quantised(speed, recipe.speed_step_mps));
    sample.yaw_rate_radps =
        quantised(state.yaw_rate_radps + bias + recipe.yaw_rate_noise_radps * yaw_rate_noise.normal(),
                  recipe.yaw_rate_step_radps);
    drive.odometry.push_back(sample);
    bias += walk * calibration.normal();
  }
}

}  // namespace waymark::simulation
