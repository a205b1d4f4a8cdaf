/// How wrong a pseudorange or a range rate is, by its satellite's signal.
#pragma once

#include <optional>
#include <vector>

#include <waymark/core/graph/loss.hpp>
#include <waymark/core/registry/options.hpp>
#include <waymark/plugins/gnss_raw/detail/epochs.hpp>

namespace waymark::plugins::gnss_raw {

/// The error of one pseudorange, m.
struct RangeNoise {
  double white_m = 1;    ///< standard deviation of the part that each epoch draws anew
  double lasting_m = 0;  ///< EdgeGnssPseudorange::spread of the part that lasts for seconds: reflections
  double slow_m = 0;     ///< standard deviation of the part that lasts for an hour: orbit, ionosphere
};

/// With the factor w = 10^((45 - C/N0) / 20), 1 from 45 dB-Hz on and without C/N0, and the obliquity
/// m = 1 / sin(elevation), 1 to 5:
///   white = pseudorange_sigma w sqrt(m), lasting = multipath_sigma w sqrt(m) / d(reflection_skew),
///   slow = slow_sigma sqrt(m), twice that for GLONASS.
/// d(skew) is the deviation of late errors of a unit spread, exp(skew^2 / 2) sqrt(exp(skew^2) - 1) / skew.
/// The receiver delays each of GLONASS's channels by another time, which adds some metres.
class Noise {
 public:
  struct Parameters {
    double pseudorange_sigma_m = 1;
    double range_rate_sigma_mps = 1;
    double range_rate_time_s = 1;
    double multipath_spread_m = 1;  ///< multipath_sigma / d(reflection_skew)
    double slow_sigma_m = 1;
    double reflection_skew = 0;
    std::optional<Loss> tails{};
  };

  explicit Noise(Parameters parameters) : parameters_(std::move(parameters)) {}

  [[nodiscard]] RangeNoise of(const SatelliteReading& reading) const;
  /// Returns the standard deviation with which a range rate counts. Its error lasts for a while: of
  /// readings at intervals of dt, each tells (1 - r) / (1 + r), r = exp(-dt / range_rate_time), of
  /// what it would tell alone, which is right for the mean of a first-order Gauss-Markov process.
  /// @param dt_s since the satellite's last one
  [[nodiscard]] double range_rate_sigma(const SatelliteReading& reading, double dt_s) const;
  /// Returns EdgeGnssPseudorange::skew.
  [[nodiscard]] double reflection_skew() const { return parameters_.reflection_skew; }
  [[nodiscard]] const std::optional<Loss>& tails() const { return parameters_.tails; }

 private:
  Parameters parameters_;
};

[[nodiscard]] std::vector<OptionInfo> noise_options();
[[nodiscard]] Noise read_noise(const CheckedOptions& options);

}  // namespace waymark::plugins::gnss_raw
