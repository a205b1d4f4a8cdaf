/// A histogram of durations that takes no more memory the longer it is kept.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace waymark::live {

class LatencyHistogram {
 public:
  void add(double microseconds) {
    const double place = microseconds > 0.1 ? kPerOctave * std::log2(microseconds / 0.1) : 0;
    const auto bucket = static_cast<std::size_t>(place);
    ++counts_[bucket < kBuckets ? bucket : kBuckets - 1];
    ++count_;
    if (microseconds > largest_) largest_ = microseconds;
  }
  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] double largest_us() const { return largest_; }
  /// Returns the upper end of the bucket that holds a share of all, at most 9 % above the exact value.
  [[nodiscard]] double quantile_us(double share) const {
    const auto needed = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count_)));
    std::uint64_t sum = 0;
    for (std::size_t bucket = 0; bucket < kBuckets; ++bucket) {
      sum += counts_[bucket];
      if (sum >= needed && sum > 0)
        return std::fmin(largest_, 0.1 * std::exp2(static_cast<double>(bucket + 1) / kPerOctave));
    }
    return largest_;
  }
  /// Returns the buckets from the first to the last that is not empty: upper end in us, and count.
  [[nodiscard]] std::vector<std::pair<double, std::uint64_t>> buckets() const {
    std::vector<std::pair<double, std::uint64_t>> found;
    std::size_t end = 0;
    for (std::size_t bucket = 0; bucket < kBuckets; ++bucket) {
      if (counts_[bucket] == 0 && found.empty()) continue;
      found.emplace_back(0.1 * std::exp2(static_cast<double>(bucket + 1) / kPerOctave), counts_[bucket]);
      if (counts_[bucket] > 0) end = found.size();
    }
    found.resize(end);
    return found;
  }

 private:
  static constexpr double kPerOctave = 8;
  static constexpr std::size_t kBuckets = 240;  // up to 100 s
  std::array<std::uint64_t, kBuckets> counts_{};
  std::uint64_t count_ = 0;
  double largest_ = 0;
};

}  // namespace waymark::live
