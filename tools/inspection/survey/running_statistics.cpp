#include <waymark/tools/inspection/survey/running_statistics.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

#include <waymark/core/base/detail/median.hpp>

namespace waymark::inspection {
namespace {

constexpr unsigned kBinBits = 5;  // bits of the mantissa: 32 bins per octave
constexpr int kLowestExponent = -30;
constexpr int kOctaves = 70;
constexpr std::size_t kBins = (static_cast<std::size_t>(kOctaves) << kBinBits) + 1;
constexpr std::size_t kKept = 1024;
constexpr std::size_t kLongest = 5;

/// Returns seconds, exact to the nanosecond if possible. Stamps of a damaged log may be as far
/// apart as int64 allows.
double seconds_from(Stamp earlier, Stamp later) {
  const double rough = later.seconds() - earlier.seconds();
  return std::abs(rough) < 1e9 ? seconds_between(earlier, later) : rough;
}

}  // namespace

/// Bin 0 holds sizes near zero. The exponent and the first bits of the mantissa are the bin, so no
/// logarithm is needed.
std::size_t Quantiles::bin_of(double size) {
  constexpr std::uint64_t kBias = 1023 + kLowestExponent;
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(size) >> (52 - kBinBits);
  if (bits < kBias << kBinBits) return 0;
  return std::min<std::uint64_t>(bits - (kBias << kBinBits) + 1, kBins - 1);
}

void Quantiles::add(double value) {
  if (!std::isfinite(value)) return;
  if (bins_.empty()) bins_.resize(kBins);
  Bin& bin = bins_[bin_of(std::abs(value))];
  ++bin.count;
  bin.sum += std::abs(value);
  ++count_;
}

double Quantiles::quantile(double share) const {
  if (count_ == 0) return std::numeric_limits<double>::quiet_NaN();
  const auto rank = static_cast<std::size_t>(share * static_cast<double>(count_ - 1));
  std::size_t below = 0;
  for (const Bin& bin : bins_) {
    below += bin.count;
    if (below > rank) return bin.sum / static_cast<double>(bin.count);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

std::size_t Quantiles::count_above(double limit) const {
  std::size_t above = 0;
  for (const Bin& bin : bins_) {
    if (bin.count > 0 && bin.sum > limit * static_cast<double>(bin.count)) above += bin.count;
  }
  return above;
}

void EvenSample::add(double value) {
  if (count_++ % spacing_ != 0) return;
  kept_.push_back(value);
  if (kept_.size() < kKept) return;
  for (std::size_t i = 0; 2 * i < kept_.size(); ++i) kept_[i] = kept_[2 * i];
  kept_.resize((kept_.size() + 1) / 2);
  spacing_ *= 2;
}

double EvenSample::median() const {
  return kept_.empty() ? std::numeric_limits<double>::quiet_NaN() : upper_median(kept_);
}

void StampSeries::add(Stamp stamp, std::size_t line) {
  if (count_++ == 0) {
    earliest_ = latest_ = last_ = stamp;
    return;
  }
  const double seconds = seconds_from(last_, stamp);
  if (seconds < 0) backwards_.see(line, stamp, -seconds);
  if (seconds == 0) duplicates_.see(line, stamp);
  if (seconds > kClockJump) jumps_.see(line, stamp, seconds);
  if (seconds > 0) {
    intervals_.add(seconds);
    keep_longest({last_, seconds, line});
  }
  earliest_ = std::min(earliest_, stamp);
  latest_ = std::max(latest_, stamp);
  last_ = stamp;
}

double StampSeries::span_s() const {
  return count_ == 0 ? 0 : seconds_from(earliest_, latest_);
}

void StampSeries::keep_longest(const LongInterval& interval) {
  if (longest_.size() == kLongest && interval.seconds <= longest_.back().seconds) return;
  const auto place = std::find_if(longest_.begin(), longest_.end(), [&](const LongInterval& other) {
    return other.seconds < interval.seconds;
  });
  longest_.insert(place, interval);
  if (longest_.size() > kLongest) longest_.pop_back();
}

std::size_t StampSeries::gaps() const {
  return intervals_.count() == 0 ? 0 : intervals_.count_above(kGapFactor * median_interval_s());
}

std::vector<LongInterval> StampSeries::longest_gaps() const {
  std::vector<LongInterval> gaps = longest_;
  const double limit = kGapFactor * median_interval_s();
  std::erase_if(gaps, [&](const LongInterval& gap) { return !(gap.seconds > limit); });
  return gaps;
}

}  // namespace waymark::inspection
