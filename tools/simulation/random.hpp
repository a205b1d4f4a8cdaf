/// Random numbers of our own. The distributions of the standard library differ between platforms;
/// these do not.
#pragma once

#include <array>
#include <cstdint>

namespace waymark::simulation {

/// xoshiro256++ 1.0 (Blackman & Vigna, "Scrambled linear pseudorandom number generators", 2021);
/// SplitMix64 fills its state. Integers and uniform numbers have the same bits everywhere. Normal
/// and exponential numbers use log, sin and cos of the C library, which may differ in the last bit.
class RandomStream {
 public:
  /// @param seed of the whole simulation
  /// @param stream number of the part that draws here; the streams of one seed are independent
  RandomStream(std::uint64_t seed, std::uint64_t stream);
  /// Starts from a state of the generator, not all 0. Use it for comparison with the code of
  /// its authors.
  explicit RandomStream(const std::array<std::uint64_t, 4>& state) : state_(state) {}

  [[nodiscard]] std::uint64_t bits();
  /// Returns a number in [0, 1) with 53 bits.
  [[nodiscard]] double uniform();
  [[nodiscard]] double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Returns a normal number with mean 0 and deviation 1 (Box & Muller 1958). Two uniform numbers
  /// give two of them, and the second is kept.
  [[nodiscard]] double normal();
  /// Returns an exponential number with mean 1.
  [[nodiscard]] double exponential();

 private:
  std::array<std::uint64_t, 4> state_{};
  double kept_ = 0;
  bool has_kept_ = false;
};

/// A stationary first-order Gauss-Markov process (Ornstein & Uhlenbeck 1930) with mean 0, deviation
/// 1 and autocorrelation exp(-dt / tau), sampled exactly.
class GaussMarkov {
 public:
  /// @param tau_s  correlation time, > 0
  explicit GaussMarkov(double tau_s) : tau_s_(tau_s) {}

  /// Returns the value dt after the previous one. The first value is drawn from the stationary
  /// distribution. @param dt_s >= 0
  [[nodiscard]] double next(double dt_s, RandomStream& random);

 private:
  double tau_s_;
  double value_ = 0;
  bool started_ = false;
};

/// A Gauss-Markov process after the filter of a receiver, y += (1 - a)(u - y) with a = exp(-dt /
/// smoothing), at evenly spaced instants. It has mean 0 and deviation 1. With phi = exp(-dt / tau)
/// its autocorrelation at k steps is (phi^(k+1) (1 - a^2) - a^(k+1) (1 - phi^2)) / ((phi - a)(1 +
/// phi a)); without smoothing it is phi^k.
class SmoothedGaussMarkov {
 public:
  /// @param smoothing_s  0: none
  SmoothedGaussMarkov(double tau_s, double smoothing_s, double dt_s);

  [[nodiscard]] double next(RandomStream& random);

 private:
  GaussMarkov input_;
  double dt_s_;
  double kept_;        // a
  double covariance_;  // of input and output, stationary
  double deviation_;   // of the output, stationary
  double output_ = 0;
  bool started_ = false;
};

}  // namespace waymark::simulation
