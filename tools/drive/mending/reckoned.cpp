#include <waymark/tools/drive/mending/reckoned.hpp>

#include <algorithm>
#include <cstddef>

namespace waymark::drive {

Reckoned reckoned(std::span<const OdometrySample> samples, std::span<const Fix> fixes) {
  Reckoned result;
  Complex place = 0;
  double heading = 0;
  const auto later =
      std::upper_bound(samples.begin(), samples.end(), fixes.front().stamp,
                       [](Stamp stamp, const OdometrySample& sample) { return stamp < sample.stamp; });
  auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, later - samples.begin() - 1));
  const auto ahead = [&](double dt) {
    return std::polar(samples[i].speed_mps * dt, heading + 0.5 * dt * samples[i].yaw_rate_radps);
  };
  for (const Fix& fix : fixes) {
    for (; i + 1 < samples.size() && samples[i + 1].stamp <= fix.stamp; ++i) {
      const double dt = seconds_between(samples[i].stamp, samples[i + 1].stamp);
      place += ahead(dt);
      heading += dt * samples[i].yaw_rate_radps;
    }
    result.places.push_back(place + ahead(seconds_between(samples[i].stamp, fix.stamp)));
    if (result.places.size() > 1) result.length_m += std::abs(result.places.back() - result.places.end()[-2]);
  }
  return result;
}

}  // namespace waymark::drive
