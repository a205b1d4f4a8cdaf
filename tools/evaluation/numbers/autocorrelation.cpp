#include <waymark/tools/evaluation/numbers/autocorrelation.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>

#include <fmt/format.h>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/tools/evaluation/numbers/metrics.hpp>

namespace waymark::evaluation {
namespace {

/// From here on adjacent lags are combined; the width of a group is a fraction of its lag.
constexpr std::int64_t kFirstWideLag = 32;

/// The sum of the products of the pairs at one lag.
struct LagSum {
  double products = 0;
  std::size_t pairs = 0;
};

/// A series in order of time.
class Series {
 public:
  Series(std::span<const Stamp> stamps, std::span<const Eigen::Vector2d> errors) {
    if (stamps.size() != errors.size())
      throw UsageError(fmt::format("autocorrelation: {} errors for {} stamps", errors.size(), stamps.size()));
    std::vector<std::size_t> order(stamps.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return stamps[a] < stamps[b]; });
    for (const std::size_t i : order) {
      times_.push_back(stamps[i].nanoseconds);
      errors_.push_back(errors[i]);
    }
    find_interval();
    add_up();
  }

  [[nodiscard]] std::size_t size() const { return times_.size(); }
  /// Returns the median of the intervals between different stamps; 0 if there is none.
  [[nodiscard]] std::int64_t interval() const { return interval_; }
  [[nodiscard]] std::int64_t span() const { return times_.empty() ? 0 : times_.back() - times_.front(); }

  [[nodiscard]] double sum_of_squares() const {
    double sum = 0;
    for (const Eigen::Vector2d& error : errors_) sum += error.squaredNorm();
    return sum;
  }

  void remove_mean() {
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& error : errors_) mean += error;
    mean /= static_cast<double>(errors_.size());
    for (Eigen::Vector2d& error : errors_) error -= mean;
    add_up();
  }

  /// Sums the pairs at least `low` and less than `high` apart, so that adjacent ranges
  /// share none. O(n).
  [[nodiscard]] LagSum between(std::int64_t low, std::int64_t high) const {
    LagSum sum;
    std::size_t first = 0;
    std::size_t end = 0;
    for (std::size_t i = 0; i < times_.size(); ++i) {
      while (first < times_.size() && times_[first] - times_[i] < low) ++first;
      while (end < times_.size() && times_[end] - times_[i] < high) ++end;
      const std::size_t begin = std::max(first, i + 1);
      if (begin >= end) continue;
      sum.products += errors_[i].dot(sums_[end] - sums_[begin]);
      sum.pairs += end - begin;
    }
    return sum;
  }

  /// Sums the pairs at this lag, within half an interval.
  [[nodiscard]] LagSum at_lag(std::int64_t lag) const {
    const std::int64_t low = lag - interval_ / 2;
    return between(low, low + interval_);
  }

  /// Sums the pairs k, k + 1, ... k + count - 1 intervals apart, rounded.
  [[nodiscard]] LagSum at_multiples(std::int64_t k, std::int64_t count) const {
    const std::int64_t low = k * interval_ - interval_ / 2;
    return between(low, low + count * interval_);
  }

 private:
  void find_interval() {
    std::vector<std::int64_t> intervals;
    for (std::size_t i = 1; i < times_.size(); ++i) {
      if (times_[i] > times_[i - 1]) intervals.push_back(times_[i] - times_[i - 1]);
    }
    if (!intervals.empty()) interval_ = upper_median(std::move(intervals));
  }

  void add_up() {
    sums_.assign(1, Eigen::Vector2d::Zero());
    for (const Eigen::Vector2d& error : errors_) sums_.push_back(sums_.back() + error);
  }

  std::vector<std::int64_t> times_;
  std::vector<Eigen::Vector2d> errors_;
  std::vector<Eigen::Vector2d> sums_;  // of the errors before each one
  std::int64_t interval_ = 0;
};

/// Finds where the correlation falls to 1/e, in intervals, by interpolating between the lags.
class CorrelationTime {
 public:
  void see(double lag, double correlation) {
    constexpr double kFallen = 1 / std::numbers::e;
    if (found_) return;
    if (correlation < kFallen) {
      time_ = last_lag_ + (lag - last_lag_) * (last_ - kFallen) / (last_ - correlation);
      found_ = true;
    } else {
      last_lag_ = time_ = lag;
      last_ = correlation;
    }
  }
  /// If the correlation did not fall so low, returns the largest lag seen.
  [[nodiscard]] double intervals() const { return time_; }

 private:
  double last_lag_ = 0;
  double last_ = 1;
  double time_ = 0;
  bool found_ = false;
};

}  // namespace

std::vector<double> error_autocorrelation(std::span<const Stamp> stamps,
                                          std::span<const Eigen::Vector2d> offsets,
                                          std::span<const double> lags_s) {
  Series series(stamps, offsets);
  std::vector<double> correlations(lags_s.size(), kUndefined);
  if (series.interval() == 0) return correlations;
  series.remove_mean();
  const double mean_square = series.sum_of_squares() / static_cast<double>(series.size());
  if (!(mean_square > 0)) return correlations;
  for (std::size_t k = 0; k < lags_s.size(); ++k) {
    const LagSum sum = series.at_lag(std::llround(lags_s[k] * 1e9));
    if (sum.pairs > 0) correlations[k] = sum.products / static_cast<double>(sum.pairs) / mean_square;
  }
  return correlations;
}

double effective_sample_size(std::span<const Stamp> stamps, std::span<const Eigen::Vector2d> errors) {
  const Series series(stamps, errors);
  const auto n = static_cast<double>(series.size());
  const double squares = series.sum_of_squares();
  if (series.size() < 2 || !(squares > 0)) return n;
  if (series.interval() == 0) return 1;  // all errors are of one epoch

  const std::int64_t lags = series.span() / series.interval() + 1;
  CorrelationTime tau;
  double inflation = 0;  // 1 + 2 sum rho_k
  std::int64_t width = 1;
  for (std::int64_t k = 0; k <= lags; k += 2 * width) {
    width = std::max(std::int64_t{1}, k / kFirstWideLag);
    double group = k == 0 ? 1 : 0;
    std::size_t pairs = 0;
    for (const std::int64_t lag : {k, k + width}) {
      const LagSum sum = series.at_multiples(lag, width);
      group += 2 * sum.products / squares;
      pairs += sum.pairs;
      if (lag > 0 && sum.pairs > 0)
        tau.see(static_cast<double>(lag) + 0.5 * static_cast<double>(width - 1),
                sum.products / static_cast<double>(sum.pairs) * n / squares);
    }
    if (pairs == 0) continue;  // a gap of the series does not show its correlation
    if (group <= 0) break;
    inflation += group;
  }
  const double intervals = static_cast<double>(series.span()) / static_cast<double>(series.interval()) + 1;
  double effective = std::min(n, intervals / tau.intervals());
  if (inflation > 0) effective = std::min(effective, n / inflation);
  return std::max(effective, 1.0);
}

}  // namespace waymark::evaluation
