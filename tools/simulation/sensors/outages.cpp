#include <algorithm>
#include <cmath>

#include <waymark/tools/simulation/sensors/sensors.hpp>

namespace waymark::simulation {

std::vector<bool> draw_outages(std::size_t epochs, int missing, double mean_length, RandomStream random) {
  std::vector<bool> out(epochs, false);
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

}  // namespace waymark::simulation
