/// Statistics of streams of any length, in fixed memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <waymark/core/drive/stamp.hpp>

namespace waymark::inspection {

/// The smallest and the largest value.
struct Range {
  std::size_t count = 0;
  double smallest = std::numeric_limits<double>::infinity();
  double largest = -std::numeric_limits<double>::infinity();

  void add(double value) {
    ++count;
    if (value < smallest) smallest = value;
    if (value > largest) largest = value;
  }
};

/// Quantiles of sizes |x|, from a histogram with 32 bins per octave between 2^-30 and 2^40. Smaller
/// sizes count as 0, larger ones fall into the last bin. A quantile is the mean of the sizes in its
/// bin: within 3.2 %, and exact for a constant.
class Quantiles {
 public:
  void add(double value);
  [[nodiscard]] std::size_t count() const { return count_; }
  /// @param share 0 .. 1 @return NaN if nothing was added
  [[nodiscard]] double quantile(double share) const;
  [[nodiscard]] double median() const { return quantile(0.5); }
  /// Counts the sizes in bins whose mean is above a limit.
  [[nodiscard]] std::size_t count_above(double limit) const;

 private:
  struct Bin {
    std::size_t count = 0;
    double sum = 0;
  };
  [[nodiscard]] static std::size_t bin_of(double size);

  std::vector<Bin> bins_;  ///< allocated with the first number
  std::size_t count_ = 0;
};

/// Medians of signed numbers, from at most 1024 of them at even spacing. When the sample is full,
/// every second one is dropped and the spacing doubles. The median is exact up to 1024 numbers.
class EvenSample {
 public:
  void add(double value);
  /// Returns NaN if nothing was added.
  [[nodiscard]] double median() const;
  [[nodiscard]] std::size_t count() const { return count_; }

 private:
  std::vector<double> kept_;
  std::size_t count_ = 0;
  std::size_t spacing_ = 1;
};

/// An observation: how often it was made, and where first.
struct Sighting {
  std::size_t count = 0;
  std::size_t line = 0;  ///< record of the first in the log; 0: not known
  Stamp stamp;           ///< of the first
  double amount = 0;     ///< of the first; each kind of sighting defines it

  void see(std::size_t at_line, Stamp at, double how_much = 0) {
    if (count++ == 0) {
      line = at_line;
      stamp = at;
      amount = how_much;
    }
  }
};

/// A stretch of time without a sample.
struct LongInterval {
  Stamp begin;
  double seconds = 0;
  std::size_t line = 0;  ///< record of the sample after it
};

/// A longer step between consecutive stamps is a jump of the clock or an interruption of the log.
inline constexpr double kClockJump = 3600;
/// An interval this many times the median is a gap.
inline constexpr double kGapFactor = 2.5;

/// The stamps of one stream.
class StampSeries {
 public:
  void add(Stamp stamp, std::size_t line);

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] Stamp earliest() const { return earliest_; }
  [[nodiscard]] Stamp latest() const { return latest_; }
  [[nodiscard]] double span_s() const;
  /// Returns NaN for fewer than two stamps.
  [[nodiscard]] double median_interval_s() const { return intervals_.median(); }
  [[nodiscard]] std::size_t gaps() const;
  /// Returns the longest gaps, at most five, longest first.
  [[nodiscard]] std::vector<LongInterval> longest_gaps() const;
  [[nodiscard]] const Sighting& backwards() const { return backwards_; }  ///< amount: seconds back
  /// equal to its predecessor
  [[nodiscard]] const Sighting& duplicates() const { return duplicates_; }
  [[nodiscard]] const Sighting& jumps() const { return jumps_; }  ///< amount: seconds forward

 private:
  void keep_longest(const LongInterval& interval);

  std::size_t count_ = 0;
  Stamp earliest_, latest_, last_;
  Quantiles intervals_;
  std::vector<LongInterval> longest_;
  Sighting backwards_, duplicates_, jumps_;
};

}  // namespace waymark::inspection
