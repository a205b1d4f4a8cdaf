#include <waymark/tools/drive/logs/clock_sync.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/tools/drive/logs/time_series.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::drive {
namespace {

constexpr double kCoarseStep = 0.1;     // s
constexpr double kFineStep = 0.001;     // s
constexpr double kSlow = 3;             // m/s: at lower speeds a course means little
constexpr double kFastest = 70;         // m/s: a higher speed between fixes is a jump
constexpr double kShortestChord = 2;    // m
constexpr double kLongestInterval = 5;  // s between fixes that are compared
constexpr double kDopplerWindow = 0.2;  // s around the stamp of a Doppler speed
constexpr double kLeastCorrelation = 0.25;
constexpr std::size_t kLeastSamples = 30;
constexpr double kOutlier = 4;  // median absolute deviations, scaled to a standard deviation

/// A GNSS measurement over a stretch of time.
struct Stretch {
  Stamp from;
  Stamp to;
  double value = 0;  ///< mean over it: m/s, rad/s
};

struct Comparison {
  std::string against;
  std::vector<Stretch> stretches;
};

Stamp halfway(Stamp a, Stamp b) {
  return {a.nanoseconds + (b.nanoseconds - a.nanoseconds) / 2};
}

/// Returns the fixes of the receiver with the most fixes.
std::vector<const Fix*> of_one_receiver(const std::vector<Fix>& fixes) {
  std::vector<std::vector<const Fix*>> by_source;
  for (const Fix& fix : fixes) {
    const auto source = static_cast<std::size_t>(fix.source);
    if (by_source.size() <= source) by_source.resize(source + 1);
    by_source[source].push_back(&fix);
  }
  return *std::max_element(by_source.begin(), by_source.end(),
                           [](const auto& a, const auto& b) { return a.size() < b.size(); });
}

bool neighbours(const Fix& a, const Fix& b) {
  const double dt = seconds_between(a.stamp, b.stamp);
  return dt > 0 && dt <= kLongestInterval;
}

Comparison gnss_speeds(const std::vector<const Fix*>& fixes) {
  const auto given =
      std::count_if(fixes.begin(), fixes.end(), [](const Fix* f) { return f->speed_mps.has_value(); });
  if (2 * static_cast<std::size_t>(given) > fixes.size()) {
    Comparison result{"receiver's speed", {}};
    for (const Fix* fix : fixes) {
      if (fix->speed_mps && *fix->speed_mps < kFastest)
        result.stretches.push_back(
            {fix->stamp.later(-kDopplerWindow / 2), fix->stamp.later(kDopplerWindow / 2), *fix->speed_mps});
    }
    return result;
  }
  Comparison result{"distance between fixes", {}};
  for (std::size_t i = 1; i < fixes.size(); ++i) {
    if (!neighbours(*fixes[i - 1], *fixes[i])) continue;
    const double speed = (fixes[i]->position - fixes[i - 1]->position).norm() /
                         seconds_between(fixes[i - 1]->stamp, fixes[i]->stamp) / fixes[i]->grid_scale;
    if (speed < kFastest) result.stretches.push_back({fixes[i - 1]->stamp, fixes[i]->stamp, speed});
  }
  return result;
}

/// Adds the turn between two directions of travel.
void add_turn(Comparison& to, Stamp from, double from_angle, Stamp until, double until_angle) {
  const double dt = seconds_between(from, until);
  if (dt <= 0 || dt > kLongestInterval) return;
  to.stretches.push_back({from, until, wrap_angle(until_angle - from_angle) / dt});
}

Comparison gnss_turns(const std::vector<const Fix*>& fixes) {
  const auto usable = [](const Fix* f) { return f->heading_rad && f->speed_mps.value_or(0) >= kSlow; };
  const auto given = std::count_if(fixes.begin(), fixes.end(), usable);
  if (2 * static_cast<std::size_t>(given) > fixes.size() / 2) {
    Comparison result{"receiver's course", {}};
    for (std::size_t i = 1; i < fixes.size(); ++i) {
      if (usable(fixes[i - 1]) && usable(fixes[i]))
        add_turn(result, fixes[i - 1]->stamp, *fixes[i - 1]->heading_rad, fixes[i]->stamp,
                 *fixes[i]->heading_rad);
    }
    return result;
  }
  Comparison result{"angle between fixes", {}};
  for (std::size_t i = 2; i < fixes.size(); ++i) {
    if (!neighbours(*fixes[i - 2], *fixes[i - 1]) || !neighbours(*fixes[i - 1], *fixes[i])) continue;
    const Eigen::Vector2d first = fixes[i - 1]->position - fixes[i - 2]->position;
    const Eigen::Vector2d second = fixes[i]->position - fixes[i - 1]->position;
    if (std::min(first.norm(), second.norm()) < kShortestChord) continue;
    add_turn(result, halfway(fixes[i - 2]->stamp, fixes[i - 1]->stamp), std::atan2(first.y(), first.x()),
             halfway(fixes[i - 1]->stamp, fixes[i]->stamp), std::atan2(second.y(), second.x()));
  }
  return result;
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
  Correlator(const TimeSeries& odometry, const std::vector<Stretch>& stretches, double largest_s)
      : integral_(odometry) {
    // Only stretches that the odometry covers at every offset are used, so that the same readings
    // judge all offsets.
    for (const Stretch& stretch : stretches) {
      if (stretch.from.later(-largest_s) >= odometry.stamps.front() &&
          stretch.to.later(largest_s) <= odometry.stamps.back())
        stretches_.push_back(stretch);
    }
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

  [[nodiscard]] double best(double largest_s) const {
    const double coarse = best(-largest_s, largest_s, kCoarseStep);
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
  std::vector<Stretch> stretches_;
};

std::optional<ClockOffset> compare(const TimeSeries& odometry, const Comparison& gnss, double largest_s) {
  Correlator correlator(odometry, gnss.stretches, largest_s);
  if (correlator.size() < kLeastSamples) return std::nullopt;
  correlator.drop_outliers(correlator.best(largest_s));
  if (correlator.size() < kLeastSamples) return std::nullopt;
  const double late = correlator.best(largest_s);
  const double correlation = correlator.at(late).correlation;
  // Six standard deviations of chance, because the largest of some hundred offsets is examined.
  const double chance = 6 / std::sqrt(static_cast<double>(correlator.size()));
  if (!(correlation >= std::max(kLeastCorrelation, chance))) return std::nullopt;
  return ClockOffset{gnss.against, late, correlator.sigma(late), correlation, correlator.size()};
}

}  // namespace

bool ClockOffset::is_significant() const {
  return std::abs(late_s) > kOffsetSigmas * sigma_s;
}

SyncReport estimate_clock_offsets(const PreparedDrive& drive, const SyncOptions& options) {
  const std::vector<const Fix*> fixes = of_one_receiver(drive.fixes);
  const double length = seconds_between(drive.odometry.front().stamp, drive.odometry.back().stamp);
  const double largest = std::min(options.largest_s, 0.25 * length);
  TimeSeries speed = series_of(drive.odometry, &OdometrySample::speed_mps);
  // the speed of a receiver has no sign
  for (double& value : speed.values) value = std::abs(value);
  return {compare(speed, gnss_speeds(fixes), largest),
          compare(series_of(drive.odometry, &OdometrySample::yaw_rate_radps), gnss_turns(fixes), largest)};
}

}  // namespace waymark::drive
