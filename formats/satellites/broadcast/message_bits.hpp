/// Bits of a navigation message, numbered from 0 in the order of transmission.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

namespace waymark::formats::satellites {

/// A part of a number: its first bit and how many.
struct BitRange {
  std::size_t begin = 0;
  std::size_t width = 0;
};

class MessageBits {
 public:
  /// Appends the lowest bits of a word, the highest of them first.
  void append(std::uint32_t word, std::size_t width) {
    for (std::size_t i = width; i-- > 0;) bits_.push_back((word >> i & 1U) != 0);
  }
  [[nodiscard]] std::size_t size() const { return bits_.size(); }
  /// Precondition of all readers: the bits are there, and a number has 32 at most.
  [[nodiscard]] std::uint32_t whole(std::size_t begin, std::size_t width) const {
    std::uint32_t value = 0;
    for (std::size_t i = begin; i < begin + width; ++i) value = value << 1U | (bits_[i] ? 1U : 0U);
    return value;
  }
  /// A number whose bits stand in two places, the higher ones in the first.
  [[nodiscard]] std::uint32_t whole(BitRange high, BitRange low) const {
    return whole(high.begin, high.width) << low.width | whole(low.begin, low.width);
  }
  /// A number in two's complement, in units of 2^exponent.
  [[nodiscard]] double scaled(std::size_t begin, std::size_t width, int exponent) const {
    return std::ldexp(twos_complement(whole(begin, width), width), exponent);
  }
  [[nodiscard]] double scaled(BitRange high, BitRange low, int exponent) const {
    return std::ldexp(twos_complement(whole(high, low), high.width + low.width), exponent);
  }
  /// A number without a sign, in units of 2^exponent.
  [[nodiscard]] double positive(std::size_t begin, std::size_t width, int exponent) const {
    return std::ldexp(static_cast<double>(whole(begin, width)), exponent);
  }

 private:
  static double twos_complement(std::uint32_t value, std::size_t width) {
    const auto whole = static_cast<std::int64_t>(value);
    return static_cast<double>((value >> (width - 1) & 1U) != 0 ? whole - (std::int64_t{1} << width) : whole);
  }

  std::vector<bool> bits_;
};

/// Angles are sent in semicircles.
inline constexpr double kSemicircle_rad = std::numbers::pi;

}  // namespace waymark::formats::satellites
