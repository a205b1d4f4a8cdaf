#include <algorithm>
#include <cmath>
#include <numbers>

#include <waymark/tools/simulation/sensors/sensors.hpp>

namespace waymark::simulation {

std::vector<Eigen::Vector2d> draw_bursts(const std::vector<bool>& canyon, const GnssRecipe& recipe,
                                         RandomStream random) {
  std::vector<Eigen::Vector2d> sum(canyon.size(), Eigen::Vector2d::Zero());
  if (recipe.bursts_per_minute <= 0) return sum;
  const double interval_s = 1 / recipe.rate_hz;
  const double mean_gap_s = 60 / recipe.bursts_per_minute;
  double until_next_s = mean_gap_s * random.exponential();  // of time spent in canyons
  for (std::size_t epoch = 0; epoch < canyon.size(); ++epoch) {
    if (!canyon[epoch]) continue;
    until_next_s -= interval_s;
    while (until_next_s < 0) {
      // into the interval before this epoch
      const double begin_s = std::clamp(interval_s + until_next_s, 0.0, interval_s);
      const double size = recipe.burst_size_m * random.exponential();
      const double direction = 2 * std::numbers::pi * random.uniform();
      const double duration = recipe.burst_duration_s * random.exponential();
      const Eigen::Vector2d peak = size * Eigen::Vector2d(std::cos(direction), std::sin(direction));
      const double reached = 1 - std::exp(-duration / recipe.burst_rise_s);
      for (std::size_t later = epoch; later < canyon.size(); ++later) {
        const double t = interval_s * static_cast<double>(later - epoch) + interval_s - begin_s;
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

}  // namespace waymark::simulation
