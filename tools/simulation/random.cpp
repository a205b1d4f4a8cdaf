#include <waymark/tools/simulation/random.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace waymark::simulation {
namespace {

/// Steele, Lea & Flood 2014.
std::uint64_t split_mix(std::uint64_t& state) {
  state += 0x9e3779b97f4a7c15U;
  std::uint64_t z = state;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31U);
}

}  // namespace

RandomStream::RandomStream(std::uint64_t seed, std::uint64_t stream) {
  // Seed and stream are mixed one after the other, because both are small numbers close
  // to each other.
  std::uint64_t mixed = seed;
  mixed = split_mix(mixed) ^ (stream * 0xd1342543de82ef95U);
  for (std::uint64_t& word : state_) word = split_mix(mixed);
}

std::uint64_t RandomStream::bits() {
  auto& s = state_;
  const std::uint64_t result = std::rotl(s[0] + s[3], 23) + s[0];
  const std::uint64_t t = s[1] << 17U;
  s[2] ^= s[0];
  s[3] ^= s[1];
  s[1] ^= s[2];
  s[0] ^= s[3];
  s[2] ^= t;
  s[3] = std::rotl(s[3], 45);
  return result;
}

double RandomStream::uniform() {
  return static_cast<double>(bits() >> 11U) * 0x1p-53;
}

double RandomStream::normal() {
  if (has_kept_) {
    has_kept_ = false;
    return kept_;
  }
  const double radius = std::sqrt(2 * exponential());
  const double angle = 2 * std::numbers::pi * uniform();
  kept_ = radius * std::sin(angle);
  has_kept_ = true;
  return radius * std::cos(angle);
}

double RandomStream::exponential() {
  return -std::log1p(-uniform());
}

double GaussMarkov::next(double dt_s, RandomStream& random) {
  const double kept = started_ ? std::exp(-dt_s / tau_s_) : 0;
  started_ = true;
  value_ = kept * value_ + std::sqrt(1 - kept * kept) * random.normal();
  return value_;
}

SmoothedGaussMarkov::SmoothedGaussMarkov(double tau_s, double smoothing_s, double dt_s)
    : input_(tau_s), dt_s_(dt_s), kept_(smoothing_s > 0 ? std::exp(-dt_s / smoothing_s) : 0) {
  const double phi = std::exp(-dt_s / tau_s);
  covariance_ = (1 - kept_) / (1 - phi * kept_);
  deviation_ = std::sqrt((1 - kept_) / (1 + kept_) * (1 + phi * kept_) / (1 - phi * kept_));
}

double SmoothedGaussMarkov::next(RandomStream& random) {
  const double input = input_.next(dt_s_, random);
  const double own =
      // of the stationary start; always drawn, so that later numbers stay the same
      random.normal();
  if (started_) {
    output_ = kept_ * output_ + (1 - kept_) * input;
  } else {
    output_ = covariance_ * input +
              std::sqrt(std::max(0.0, deviation_ * deviation_ - covariance_ * covariance_)) * own;
  }
  started_ = true;
  return output_ / deviation_;
}

}  // namespace waymark::simulation
