#include <waymark/tools/drive/clocks/clock_sync.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/tools/drive/clocks/gnss_motion.hpp>
#include <waymark/tools/drive/clocks/lag_search.hpp>
#include <waymark/tools/drive/logs/time_series.hpp>

namespace waymark::drive {
namespace {

constexpr double kCoarseStep = 0.1;  // s
constexpr double kFineStep = 0.001;  // s
constexpr double kLeastCorrelation = 0.25;
constexpr std::size_t kLeastSamples = 20;
constexpr double kReach = 1.5;  // s about the place where the logs fit
constexpr double kOutlier = 4;  // median absolute deviations, scaled to a standard deviation

/// Tells whether a series has values all the time. @param silence_s longest time between two readings
bool is_covered(const TimeSeries& series, Stamp from, Stamp to, double silence_s) {
  const double length_s = seconds_between(from, to);
  const double steps = std::ceil(length_s / silence_s);
  for (double i = 0; i <= steps; ++i)
    if (!value_at(series, from.later(length_s * i / steps), silence_s)) return false;
  return true;
}

/// A line through pairs (odometry, GNSS), and the quality of its fit.
struct Line {
  double slope = 0;
  double intercept = 0;
  double correlation = 0;
};

Line fit(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double mean_x = 0;
  double mean_y = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += x[i] / n;
    mean_y += y[i] / n;
  }
  double xx = 0;
  double xy = 0;
  double yy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
    yy += (y[i] - mean_y) * (y[i] - mean_y);
  }
  if (!(xx > 0 && yy > 0)) return {};
  const double slope = xy / xx;
  return {slope, mean_y - slope * mean_x, xy / std::sqrt(xx * yy)};
}

/// The odometry side of a comparison.
class Correlator {
 public:
  /// @param about_s middle of the offsets that are compared
  Correlator(const TimeSeries& odometry, const std::vector<Stretch>& stretches, double about_s)
      : integral_(odometry), about_s_(about_s) {
    // Only stretches that the odometry covers at every offset are used, so that the same readings
    // judge all offsets.
    const double silence_s = longest_silence_s(odometry, kLongestSilence_s);
    for (const Stretch& stretch : stretches)
      if (is_covered(odometry, stretch.from.later(about_s - kReach), stretch.to.later(about_s + kReach),
                     silence_s))
        stretches_.push_back(stretch);
  }

  [[nodiscard]] std::size_t size() const { return stretches_.size(); }
  [[nodiscard]] Line at(double late_s) const {
    std::vector<double> y;
    for (const Stretch& stretch : stretches_) y.push_back(stretch.value);
    return fit(odometry_at(late_s), y);
  }

  [[nodiscard]] double best(double from, double to, double step) const {
    double best = from;
    double most = -2;
    for (int i = 0; from + i * step <= to + 0.5 * step; ++i) {
      const double correlation = at(from + i * step).correlation;
      if (correlation > most) {
        most = correlation;
        best = from + i * step;
      }
    }
    return best;
  }

  [[nodiscard]] double best() const {
    const double coarse = best(about_s_ - kReach, about_s_ + kReach, kCoarseStep);
    const double finer = best(coarse - kCoarseStep, coarse + kCoarseStep, 0.01);
    return best(finer - 0.01, finer + 0.01, kFineStep);
  }

  /// The usual residual is that of the half with more motion, because standstill always fits.
  void drop_outliers(double late_s) {
    const std::vector<double> left = residuals(late_s);
    std::vector<std::pair<double, double>> by_motion;  // size of the motion, size of the residual
    for (std::size_t i = 0; i < left.size(); ++i)
      by_motion.emplace_back(std::abs(stretches_[i].value), std::abs(left[i]));
    std::sort(by_motion.begin(), by_motion.end());
    std::vector<double> lively;
    for (std::size_t i = by_motion.size() / 2; i < by_motion.size(); ++i)
      lively.push_back(by_motion[i].second);
    const double limit = kOutlier * 1.4826 * upper_median(std::move(lively));
    std::size_t index = 0;
    std::erase_if(stretches_, [&](const Stretch&) { return std::abs(left[index++]) > limit; });
  }

  [[nodiscard]] double sigma(double late_s) const {
    const Line line = at(late_s);
    const std::vector<double> left = residuals(late_s);
    const std::vector<double> before = odometry_at(late_s - 0.05);
    const std::vector<double> after = odometry_at(late_s + 0.05);
    double squares = 0;
    double products = 0;
    double information = 0;
    for (std::size_t i = 0; i < left.size(); ++i) {
      squares += left[i] * left[i];
      if (i > 0) products += left[i] * left[i - 1];
      const double rate = line.slope * (after[i] - before[i]) / 0.1;
      information += rate * rate;
    }
    const double r = std::clamp(products / squares, 0.0, 0.99);
    return std::sqrt(squares / static_cast<double>(left.size()) * (1 + r) / (1 - r) / information);
  }

 private:
  [[nodiscard]] std::vector<double> odometry_at(double late_s) const {
    std::vector<double> x;
    x.reserve(stretches_.size());
    for (const Stretch& stretch : stretches_)
      x.push_back(integral_.mean(stretch.from.later(late_s), stretch.to.later(late_s)));
    return x;
  }
  [[nodiscard]] std::vector<double> residuals(double late_s) const {
    const Line line = at(late_s);
    std::vector<double> left = odometry_at(late_s);
    for (std::size_t i = 0; i < left.size(); ++i)
      left[i] = stretches_[i].value - line.intercept - line.slope * left[i];
    return left;
  }

  SeriesIntegral integral_;
  double about_s_;
  std::vector<Stretch> stretches_;
};

std::optional<ClockOffset> compare(const TimeSeries& odometry, const GnssMotion& gnss, double about_s) {
  Correlator correlator(odometry, gnss.stretches, about_s);
  if (correlator.size() < kLeastSamples) return std::nullopt;
  correlator.drop_outliers(correlator.best());
  if (correlator.size() < kLeastSamples) return std::nullopt;
  const double late = correlator.best();
  const double correlation = correlator.at(late).correlation;
  // Three and a half standard deviations of chance, because the largest of some offsets is examined.
  const double chance = 3.5 / std::sqrt(static_cast<double>(correlator.size()));
  if (!(correlation >= std::max(kLeastCorrelation, chance))) return std::nullopt;
  return ClockOffset{gnss.source, late, correlator.sigma(late), correlation, correlator.size()};
}

}  // namespace

bool ClockOffset::is_significant() const {
  return std::abs(late_s) > kOffsetSigmas * std::hypot(sigma_s, kSmoothing_s);
}

bool ClockOffset::may_be(const ClockOffset& other) const {
  return std::abs(late_s - other.late_s) <= kOffsetSigmas * std::hypot(sigma_s, other.sigma_s, kSmoothing_s);
}

std::optional<ClockOffset> SyncReport::common() const {
  if (!speed) return yaw_rate;
  return yaw_rate && yaw_rate->sigma_s < speed->sigma_s ? yaw_rate : speed;
}

SyncReport estimate_clock_offsets(const std::vector<OdometrySample>& odometry, const std::vector<Fix>& fixes,
                                  const SyncOptions& options) {
  if (fixes.empty() || odometry.size() < 2) return {};
  const std::vector<const Fix*> receiver = of_one_receiver(fixes);
  const auto [speeds, turns] = receiver_motion(receiver);
  const std::optional<Lag> lag = LagSearch(odometry, speeds, turns).find(options.largest_s);
  if (!lag) return {};
  TimeSeries speed = series_of(odometry, &OdometrySample::speed_mps);
  // the speed of a receiver has no sign
  for (double& value : speed.values) value = std::abs(value);
  return {compare(speed, speeds, lag->late_s),
          compare(series_of(odometry, &OdometrySample::yaw_rate_radps), turns, lag->late_s)};
}

}  // namespace waymark::drive
