#include <waymark/tools/drive/clocks/lagged_path.hpp>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/tools/drive/clocks/lag_search.hpp>
#include <waymark/tools/drive/logs/time_series.hpp>

namespace waymark::drive {
namespace {

constexpr double kRaster_s = 0.05;

/// Returns a value between two points of a raster; beyond its ends that of the end.
double on_raster(const std::vector<double>& values, double time_s) {
  const double place = std::clamp(time_s / kRaster_s, 0.0, static_cast<double>(values.size() - 1));
  const std::size_t i = std::min(static_cast<std::size_t>(place), values.size() - 2);
  const double share = place - static_cast<double>(i);
  return values[i] + share * (values[i + 1] - values[i]);
}

/// Returns the integral of a series from its first reading to each point of the raster.
std::vector<double> integral_of(const TimeSeries& series, std::size_t points) {
  const SeriesIntegral integral(series);
  const Stamp first = series.stamps.front();
  std::vector<double> result{0};
  for (std::size_t i = 1; i < points; ++i) {
    const double before_s = static_cast<double>(i - 1) * kRaster_s;
    result.push_back(result.back() +
                     kRaster_s * integral.mean(first.later(before_s), first.later(before_s + kRaster_s)));
  }
  return result;
}

}  // namespace

LaggedPath::LaggedPath(const std::vector<OdometrySample>& odometry)
    : first_(odometry.front().stamp), length_s_(seconds_between(first_, odometry.back().stamp)) {
  const std::size_t points = static_cast<std::size_t>(length_s_ / kRaster_s) + 2;
  const TimeSeries speed = series_of(odometry, &OdometrySample::speed_mps);
  distance_m_ = integral_of(speed, points);
  turn_rad_ = integral_of(series_of(odometry, &OdometrySample::yaw_rate_radps), points);
  const double silence_s = longest_silence_s(speed, kLongestSilence_s);
  std::size_t next = 1;
  unknown_.push_back(0);
  for (std::size_t i = 1; i < points; ++i) {
    const Stamp now = first_.later(static_cast<double>(i) * kRaster_s);
    while (next + 1 < odometry.size() && odometry[next].stamp < now) ++next;
    const bool is_gap = seconds_between(odometry[next - 1].stamp, odometry[next].stamp) > silence_s;
    unknown_.push_back(unknown_.back() + (is_gap || odometry[next].assumed ? 1 : 0));
  }
}

bool LaggedPath::is_measured(double from_s, double to_s) const {
  return from_s >= 0 && to_s <= length_s_ && on_raster(unknown_, to_s) - on_raster(unknown_, from_s) < 0.5;
}

std::vector<Eigen::Vector2d> LaggedPath::antenna_at(std::span<const double> moments_s, const Errors& errors,
                                                    const Eigen::Vector2d& antenna_m) const {
  const auto first = static_cast<std::size_t>(moments_s.front() / kRaster_s);
  const auto last = std::min(distance_m_.size(), static_cast<std::size_t>(moments_s.back() / kRaster_s) + 2);
  const double begin_s = static_cast<double>(first) * kRaster_s;
  const auto heading_at = [&](double now_s) {
    return (1 + errors.yaw_scale) * on_raster(turn_rad_, now_s + errors.yaw_rate_lag_s) -
           errors.bias_radps * now_s;
  };
  std::vector<double> x{0};
  std::vector<double> y{0};
  std::vector<double> heading{heading_at(begin_s)};
  double distance = on_raster(distance_m_, begin_s + errors.speed_lag_s);
  for (std::size_t i = first + 1; i < last; ++i) {
    const double now_s = static_cast<double>(i) * kRaster_s;
    const double before = heading.back();
    heading.push_back(heading_at(now_s));
    const double until = on_raster(distance_m_, now_s + errors.speed_lag_s);
    const double middle = 0.5 * (before + heading.back());
    x.push_back(x.back() + (until - distance) * std::cos(middle));
    y.push_back(y.back() + (until - distance) * std::sin(middle));
    distance = until;
  }
  std::vector<Eigen::Vector2d> places;
  for (const double moment_s : moments_s) {
    const double since_s = moment_s - begin_s;
    const Eigen::Vector2d arm = Eigen::Rotation2Dd(on_raster(heading, since_s)) * antenna_m;
    places.push_back(Eigen::Vector2d(on_raster(x, since_s), on_raster(y, since_s)) + arm);
  }
  return places;
}

}  // namespace waymark::drive
