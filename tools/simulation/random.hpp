/// Random numbers of our own: the standard library's distributions differ between platforms, these do not.
#pragma once

#include <array>
#include <cstdint>

namespace waymark::simulation {

/// xoshiro256++ 1.0 (Blackman & Vigna, "Scrambled linear pseudorandom number generators", 2021), its state
/// filled by SplitMix64. Integers and uniform numbers are the same bits everywhere; normal and exponential
/// ones pass through the C library's log, sin and cos, which may differ in the last bit.
class RandomStream {
 public:
  /// @param seed    of the whole simulation
  /// @param stream  which part of it draws here: streams of one seed do not depend on each other
  RandomStream(std::uint64_t seed, std::uint64_t stream);
  /// From the generator's own state, not all 0: to compare with its authors' code.
  explicit RandomStream(const std::array<std::uint64_t, 4>& state) : state_(state) {}

  [[nodiscard]] std::uint64_t bits();
  /// In [0, 1), 53 bits.
  [[nodiscard]] double uniform();
  [[nodiscard]] double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Mean 0, deviation 1 (Box & Muller 1958); two from two uniform numbers, the second is kept.
  [[nodiscard]] double normal();
  /// Mean 1.
  [[nodiscard]] double exponential();

 private:
  std::array<std::uint64_t, 4> state_{};
  double kept_ = 0;
  bool has_kept_ = false;
};

/// A stationary first-order Gauss-Markov process (Ornstein & Uhlenbeck 1930) of mean 0 and deviation 1 with
/// autocorrelation exp(-dt / tau), sampled exactly.
class GaussMarkov {
 public:
  /// @param tau_s  correlation time, > 0
  explicit GaussMarkov(double tau_s) : tau_s_(tau_s) {}

  /// The value dt after the one before (the first: drawn from the stationary distribution). @param dt_s >= 0
  [[nodiscard]] double next(double dt_s, RandomStream& random);

 private:
  double tau_s_;
  double value_ = 0;
  bool started_ = false;
};

/// A Gauss-Markov process through a receiver's filter y += (1 - a)(u - y), a = exp(-dt / smoothing), at
/// evenly spaced instants; mean 0, deviation 1. With phi = exp(-dt / tau) its autocorrelation at k steps is
/// (phi^(k+1) (1 - a^2) - a^(k+1) (1 - phi^2)) / ((phi - a)(1 + phi a)); without smoothing phi^k.
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
