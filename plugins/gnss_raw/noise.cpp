#include <waymark/plugins/gnss_raw/detail/noise.hpp>

#include <algorithm>
#include <cmath>

namespace waymark::plugins::gnss_raw {
namespace {

constexpr double kStrongSignal_dbhz = 45;
constexpr double kGlonassChannels = 2;

double weakness(const SatelliteReading& reading) {
  if (std::isnan(reading.cn0_dbhz)) return 1;
  const double below_db = std::clamp(kStrongSignal_dbhz - reading.cn0_dbhz, 0.0, kStrongSignal_dbhz);
  return std::pow(10, below_db / 20);
}

double obliquity(const SatelliteReading& reading) {
  constexpr double kLowest = 0.2;  // 11.5 degrees
  if (std::isnan(reading.elevation_rad)) return 1;
  return 1 / std::max(kLowest, std::sin(reading.elevation_rad));
}

/// Returns the standard deviation of late(x) in EdgeGnssPseudorange, for x of deviation 1: that of a log-normal
/// distribution.
double deviation_of_late(double skew) {
  if (!(skew > 0)) return 1;
  const double growth = std::exp(skew * skew);
  return std::sqrt(growth * (growth - 1)) / skew;
}

}  // namespace

RangeNoise Noise::of(const SatelliteReading& reading) const {
  const double factor = weakness(reading) * std::sqrt(obliquity(reading));
  return {parameters_.pseudorange_sigma_m * factor, parameters_.multipath_spread_m * factor,
          parameters_.slow_sigma_m * std::sqrt(obliquity(reading)) *
              (reading.system == kGlonass ? kGlonassChannels : 1)};
}

double Noise::range_rate_sigma(const SatelliteReading& reading, double dt_s) const {
  const double half =
      0.5 * dt_s / parameters_.range_rate_time_s;  // (1 - r) / (1 + r) is its hyperbolic tangent
  return parameters_.range_rate_sigma_mps * weakness(reading) / std::sqrt(std::tanh(half));
}

std::vector<OptionInfo> noise_options() {
  return {
      {.name = "pseudorange_sigma",
       .value = "2",
       .unit = "m",
       .allowed = OptionRange{0.01, 1000},
       .text = "error of a strong signal's pseudorange that each epoch draws anew"},
      {.name = "multipath_sigma",
       .value = "3.3",
       .unit = "m",
       .allowed = OptionRange{0, 1000},
       .text = "error of a strong signal's pseudorange that lasts; 0: there is none",
       .prior = NoisePrior{.mean = 3.3, .deviation = 0.7}},
      {.name = "slow_sigma",
       .value = "2",
       .unit = "m",
       .allowed = OptionRange{0, 1000},
       .text =
           "error of a satellite's pseudorange that stays for an hour: orbit, ionosphere; 0: there is none",
       .prior = NoisePrior{.mean = 2, .deviation = 0.5}},
      {.name = "reflection_skew",
       .value = "0.8",
       .allowed = OptionRange{0, 2},
       .text =
           "how much larger late lasting errors are than early ones: a deviation x is (exp(skew x) - 1) / "
           "skew; 0: alike"},
      {.name = "range_rate_sigma",
       .value = "0.1",
       .unit = "m/s",
       .allowed = OptionRange{0.001, 100},
       .text = "error of a strong signal's range rate"},
      {.name = "range_rate_time",
       .value = "1",
       .unit = "s",
       .allowed = OptionRange{1e-3, 1000},
       .text = "how long the error of a range rate lasts"},
      {.name = "tails",
       .value = "cauchy",
       .allowed = OptionWords{"cauchy", "gaussian"},
       .text = "'cauchy': a heavy-tailed loss on pseudoranges and range rates; 'gaussian': none"},
      {.name = "tail_scale",
       .value = "0.3",
       .allowed = OptionRange{0.1, 100},
       .text = "scale of the loss, in standard deviations"}};
}

Noise read_noise(const CheckedOptions& options) {
  const double skew = options.number("reflection_skew");
  return Noise({.pseudorange_sigma_m = options.number("pseudorange_sigma"),
                .range_rate_sigma_mps = options.number("range_rate_sigma"),
                .range_rate_time_s = options.number("range_rate_time"),
                .multipath_spread_m = options.number("multipath_sigma") / deviation_of_late(skew),
                .slow_sigma_m = options.number("slow_sigma"),
                .reflection_skew = skew,
                .tails = options.word("tails") == "gaussian"
                             ? std::nullopt
                             : std::optional(builtin_loss("cauchy", options.number("tail_scale")))});
}

}  // namespace waymark::plugins::gnss_raw
