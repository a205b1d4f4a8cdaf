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
  double lasting_m = 0;  ///< standard deviation of the part that lasts
  double delay_m = 0;    ///< expectation: reflected signals come late
};

/// With the factor w = 10^((45 - C/N0) / 20), 1 from 45 dB-Hz on and without C/N0, and the obliquity
/// m = 1 / sin(elevation), 1 to 5:
///   white = pseudorange_sigma w sqrt(m), lasting = multipath_sigma w sqrt(m),
///   delay = reflection_delay (w - 1).
class Noise {
 public:
  struct Parameters {
    double pseudorange_sigma_m = 1;
    double range_rate_sigma_mps = 1;
    double multipath_sigma_m = 1;
    double reflection_delay_m = 0;
    std::optional<Loss> tails{};
  };

  explicit Noise(Parameters parameters) : parameters_(std::move(parameters)) {}

  [[nodiscard]] RangeNoise of(const SatelliteReading& reading) const;
  [[nodiscard]] double range_rate_sigma(const SatelliteReading& reading) const;
  [[nodiscard]] const std::optional<Loss>& tails() const { return parameters_.tails; }

 private:
  Parameters parameters_;
};

[[nodiscard]] std::vector<OptionInfo> noise_options();
[[nodiscard]] Noise read_noise(const CheckedOptions& options);

}  // namespace waymark::plugins::gnss_raw
