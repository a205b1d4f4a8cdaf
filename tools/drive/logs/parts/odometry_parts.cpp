#include <waymark/tools/drive/logs/parts/odometry_parts.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <optional>

#include <fmt/format.h>
#include <Eigen/Core>

#include <waymark/core/base/angle.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/channels.hpp>
#include <waymark/tools/drive/logs/parts/direction.hpp>
#include <waymark/tools/drive/logs/time_series.hpp>

namespace waymark::drive {
namespace {

constexpr double kLargestRate = 50;   // Hz, if the rate of the clock is not stated
constexpr double kCountWindow = 0.2;  // s: shortest time over which counts are differenced
// m/s: the direction of gravity is searched at lower speeds ...
constexpr double kStandstillSpeed = 0.05;
constexpr double kStandstillTime = 2;  // s: ... if they last at least this long

using Channels = std::map<std::string, TimeSeries, std::less<>>;
using Names = std::set<std::string, std::less<>>;

/// Returns how the names of the channels of a source begin.
std::string_view channels_of(std::string_view source) {
  if (source == "gyro") return "gyro_";
  if (source == "steering") return "steering_angle";
  if (source == "rear_wheels") return "wheel_speed_rear_";
  if (source == "front_wheels") return "wheel_speed_front_";
  if (source == "rear_ticks") return "wheel_ticks_rear_";
  if (source == "front_ticks") return "wheel_ticks_front_";
  return source == "ticks" ? "wheel_ticks" : source;
}

struct ChannelReading {
  Stamp stamp;
  double value = 0;
};

/// Returns readings in order of time. Of several with one stamp, the first is kept.
TimeSeries channel_of(std::vector<ChannelReading> readings) {
  std::stable_sort(readings.begin(), readings.end(),
                   [](const ChannelReading& a, const ChannelReading& b) { return a.stamp < b.stamp; });
  TimeSeries series;
  for (const ChannelReading& reading : readings) {
    if (!series.empty() && series.stamps.back() == reading.stamp) continue;
    series.stamps.push_back(reading.stamp);
    series.values.push_back(reading.value);
  }
  return series;
}

/// A channel whose column is stated comes before one of a default name.
Channels collect_channels(std::span<const OdometryPart> parts, Names& by_default) {
  Channels channels;
  std::map<std::string, std::string> origin;
  const std::vector<SensorColumn>& known = formats::odometry_channels();
  for (const OdometryPart& part : parts) {
    for (std::size_t c = 0; c < known.size(); ++c) {
      std::vector<ChannelReading> readings;
      for (std::size_t row = 0; row < part.readings.size(); ++row) {
        const double value = part.readings.at(row, c);
        if (std::isfinite(value)) readings.push_back({part.readings.stamps[row], value});
      }
      if (readings.empty()) continue;
      const bool is_stated = !part.by_default.contains(known[c].name);
      const auto [place, is_new] = origin.try_emplace(known[c].name, part.file);
      const bool was_stated = !is_new && !by_default.contains(known[c].name);
      if (was_stated && is_stated)
        throw InputError(
            fmt::format("odometry: both {} and {} have '{}'; leave it out of the columns of one of them",
                        place->second, part.file, known[c].name));
      if (!is_new && !is_stated) continue;  // of two default names, the first
      if (is_stated)
        by_default.erase(known[c].name);
      else
        by_default.insert(known[c].name);
      place->second = part.file;
      channels[known[c].name] = channel_of(std::move(readings));
    }
  }
  return channels;
}

/// Combines two channels at the times of the first, if the other one has a value there too.
template <typename Combine>
TimeSeries combined(const TimeSeries& a, const TimeSeries& b, double gap_s, Combine combine) {
  TimeSeries result;
  const double limit = longest_silence_s(b, gap_s);
  for (std::size_t i = 0; i < a.stamps.size(); ++i) {
    const std::optional<double> other = value_at(b, a.stamps[i], limit);
    if (!other) continue;
    result.stamps.push_back(a.stamps[i]);
    result.values.push_back(combine(a.values[i], *other));
  }
  return result;
}

/// Returns the rate of a running count in units per second, at the middle of each interval of at
/// least kCountWindow.
/// @param range the count restarts from 0 here; 0: never
TimeSeries rate_of_count(const TimeSeries& count, double range, double gap_s) {
  TimeSeries rate;
  const double limit = longest_silence_s(count, gap_s);
  std::size_t first = 0;
  double change = 0;
  for (std::size_t i = 1; i < count.stamps.size(); ++i) {
    double step = count.values[i] - count.values[i - 1];
    if (range > 0 && std::abs(step) > 0.5 * range) step -= std::copysign(range, step);
    const bool restart = seconds_between(count.stamps[i - 1], count.stamps[i]) > limit;
    change = restart ? 0 : change + step;
    if (restart) first = i;
    const double time = seconds_between(count.stamps[first], count.stamps[i]);
    if (time < kCountWindow) continue;
    rate.stamps.push_back({std::midpoint(count.stamps[first].nanoseconds, count.stamps[i].nanoseconds)});
    rate.values.push_back(change / time);
    first = i;
    change = 0;
  }
  return rate;
}

/// Computes speed and yaw rate from the available channels.
class Assembler {
 public:
  Assembler(Channels channels, Names by_default, const OdometryAssembly& how, double gap_s)
      : channels_(std::move(channels)), by_default_(std::move(by_default)), how_(how), gap_s_(gap_s) {}

  [[nodiscard]] AssembledOdometry run() {
    speed_ = chosen("speed", in_order(kSpeedSources), how_.speed_from,
                    [&](std::string_view source) { return speed(source); });
    flip_in_reverse();
    const TimeSeries yaw =
        chosen("yaw rate", in_order(kYawRateSources, true), how_.yaw_rate_from, [&](std::string_view source) {
          result_.yaw_rate_from = source;
          return this->yaw_rate(source);
        });
    sample(yaw);
    return std::move(result_);
  }

 private:
  /// Tells whether a source has a channel that was not only found by its default name.
  [[nodiscard]] bool is_stated(std::string_view source) const {
    return std::any_of(channels_.begin(), channels_.end(), [&](const auto& channel) {
      return channel.first.starts_with(channels_of(source)) && !by_default_.contains(channel.first);
    });
  }
  /// Returns the sources in order of preference, those of stated channels first. Wheels, ticks and steering serve
  /// other purposes than the yaw rate, too: they are stated for it if the measure that it needs is.
  [[nodiscard]] std::vector<std::string_view> in_order(std::span<const std::string_view> sources,
                                                       bool of_turns = false) const {
    std::vector<std::string_view> order(sources.begin(), sources.end());
    std::stable_partition(order.begin(), order.end(), [&](std::string_view source) {
      const bool from_wheels = source == "rear_wheels" || source == "rear_ticks";
      const double measure = from_wheels ? how_.track_width_m : how_.wheelbase_m;
      const bool is_measured = !of_turns || !is_from_wheels_or_steering(source) || measure > 0;
      return is_measured && is_stated(source);
    });
    return order;
  }

  template <typename Make>
  TimeSeries chosen(std::string_view what, const std::vector<std::string_view>& sources,
                    std::string_view stated, Make make) {
    for (const std::string_view source : sources) {
      if (!stated.empty() && source != stated) continue;
      std::optional<TimeSeries> series = make(source);
      if (!series) continue;
      if (series->stamps.size() < 2)
        throw InputError(fmt::format("odometry: {} from '{}' has {} readings; at least 2 are needed", what,
                                     source, series->stamps.size()));
      note(fmt::format("{} from {}, {:.4g} readings a second", what, described(source),
                       1 / median_interval_s(*series)));
      return std::move(*series);
    }
    throw InputError(fmt::format("odometry: no log has a channel for the {}{}; channels found: {}", what,
                                 stated.empty() ? "" : fmt::format(" from '{}', as stated", stated),
                                 present()));
  }

  [[nodiscard]] const TimeSeries* find(std::string_view channel) const {
    const auto place = channels_.find(channel);
    return place == channels_.end() ? nullptr : &place->second;
  }
  [[nodiscard]] std::string present() const {
    std::string names;
    for (const auto& [name, series] : channels_) names += (names.empty() ? "" : ", ") + name;
    return names.empty() ? "nothing" : names;
  }
  [[nodiscard]] std::string described(std::string_view source) const {
    if (source != "gyro") return fmt::format("'{}'", source);
    return fmt::format("'gyro', axis {}", how_.gyro_axis);
  }
  void note(const std::string& text) { result_.notes.push_back("odometry: " + text); }
  /// Returns a vehicle parameter that a source needs.
  [[nodiscard]] double needed(double value, std::string_view key, std::string_view source) const {
    if (value > 0) return value;
    throw InputError(fmt::format("odometry: '{}' needs 'vehicle: {{{}: ...}}'", source, key));
  }

  /// Returns half the sum of two channels of an axle, or the difference right - left over the
  /// track width.
  [[nodiscard]] std::optional<TimeSeries> of_axle(const TimeSeries* left, const TimeSeries* right,
                                                  std::string_view source, bool turning) const {
    if (left == nullptr || right == nullptr) return std::nullopt;
    if (!turning) return combined(*left, *right, gap_s_, [](double l, double r) { return 0.5 * (l + r); });
    const double track = needed(how_.track_width_m, "track_width", source);
    return combined(*left, *right, gap_s_, [track](double l, double r) { return (r - l) / track; });
  }
  [[nodiscard]] std::optional<TimeSeries> wheels(std::string_view axle, std::string_view source,
                                                 bool turning) const {
    return of_axle(find(fmt::format("wheel_speed_{}_left", axle)),
                   find(fmt::format("wheel_speed_{}_right", axle)), source, turning);
  }
  [[nodiscard]] std::optional<TimeSeries> tick_speed(std::string_view channel,
                                                     std::string_view source) const {
    const TimeSeries* count = find(channel);
    if (count == nullptr) return std::nullopt;
    const double metres = needed(how_.metres_per_tick, "metres_per_tick", source);
    TimeSeries speed = rate_of_count(*count, how_.tick_range, gap_s_);
    for (double& value : speed.values) value *= metres;
    return speed;
  }
  [[nodiscard]] std::optional<TimeSeries> ticks(std::string_view axle, std::string_view source,
                                                bool turning) const {
    const auto left = tick_speed(fmt::format("wheel_ticks_{}_left", axle), source);
    const auto right = tick_speed(fmt::format("wheel_ticks_{}_right", axle), source);
    return of_axle(left ? &*left : nullptr, right ? &*right : nullptr, source, turning);
  }

  [[nodiscard]] std::optional<TimeSeries> speed(std::string_view source) const {
    if (source == "rear_wheels") return wheels("rear", source, false);
    if (source == "front_wheels") return wheels("front", source, false);
    if (source == "rear_ticks") return ticks("rear", source, false);
    if (source == "front_ticks") return ticks("front", source, false);
    if (source == "ticks") return tick_speed("wheel_ticks", source);
    const TimeSeries* channel = find(source);
    if (channel == nullptr) return std::nullopt;
    return source == "distance" ? rate_of_count(*channel, 0, gap_s_) : *channel;
  }

  /// Returns the yaw rate; the unwrapped heading if that is the source.
  [[nodiscard]] std::optional<TimeSeries> yaw_rate(std::string_view source) {
    const TimeSeries* channel = find(source);
    yaw_is_turn_ = source == "heading" || source == "course";
    if (yaw_is_turn_ && channel != nullptr) return direction(*channel, source == "course");
    if (source == "gyro") return gyro();
    if (source == "rear_wheels") return wheels("rear", source, true);
    if (source == "rear_ticks") return ticks("rear", source, true);
    if (source == "steering") return steering();
    return channel == nullptr ? std::nullopt : std::optional(*channel);
  }

  /// Returns a heading, or a direction of motion: as stated, or as its readings at rest show.
  [[nodiscard]] TimeSeries direction(const TimeSeries& readings, bool of_motion) {
    if (!of_motion && how_.heading_is_course) {
      of_motion = true;
    } else if (const auto leaps = of_motion ? std::nullopt : leaps_at_rest(readings, speed_, gap_s_)) {
      of_motion = result_.heading_is_course = true;
      result_.warnings.push_back(fmt::format(
          "odometry: the heading leaps {} times while the vehicle stands, by up to {:.0f} deg, as the course of a "
          "receiver does: it is taken as the direction of motion; state 'course' in place of 'heading', or a source "
          "that measures all the time by 'yaw_rate_from' (channels found: {})",
          leaps->leaps, leaps->largest_rad / kDegree, present()));
    }
    Direction direction =
        of_motion ? turns_of_course(readings, speed_, gap_s_, how_.goes_on) : turns_of_heading(readings);
    turn_variance_ = std::move(direction.turn_variance_per_s);
    return std::move(direction.angle);
  }

  [[nodiscard]] std::optional<TimeSeries> gyro() {
    const std::array<const TimeSeries*, 3> axes{find("gyro_x"), find("gyro_y"), find("gyro_z")};
    if (axes[0] == nullptr && axes[1] == nullptr && axes[2] == nullptr) return std::nullopt;
    if (how_.gyro_axis.empty())
      throw InputError(
          "odometry: the yaw rate of a gyro needs 'gyro: {axis: ...}': x, y or z for the axis that points "
          "up, -x, -y or "
          "-z for one that points down, gravity to find it from the accelerometer");
    if (how_.gyro_axis == "gravity") return along_gravity(axes);
    const TimeSeries* axis = axes[static_cast<std::size_t>(how_.gyro_axis.back() - 'x')];
    if (axis == nullptr)
      throw InputError(
          fmt::format("odometry: no log has a channel 'gyro_{}' for 'gyro: {{axis: "
                      "{}}}'; channels found: {}",
                      how_.gyro_axis.back(), how_.gyro_axis, present()));
    TimeSeries rate = *axis;
    if (how_.gyro_axis.front() == '-') {
      for (double& value : rate.values) value = -value;
    }
    return rate;
  }

  /// Returns the rate about the direction that the accelerometer measures at rest. Specific force
  /// at rest points up.
  [[nodiscard]] TimeSeries along_gravity(const std::array<const TimeSeries*, 3>& axes) {
    const std::array<const TimeSeries*, 3> forces{find("acceleration_x"), find("acceleration_y"),
                                                  find("acceleration_z")};
    for (std::size_t i = 0; i < 3; ++i) {
      if (axes[i] == nullptr || forces[i] == nullptr)
        throw InputError(fmt::format(
            "odometry: 'gyro: {{axis: gravity}}' needs gyro_x, _y, _z and acceleration_x, _y, _z; "
            "channels found: {}",
            present()));
    }
    const Eigen::Vector3d up = upward(forces);
    const double limit = longest_silence_s(*axes[1], gap_s_);
    TimeSeries rate;
    for (std::size_t i = 0; i < axes[0]->stamps.size(); ++i) {
      const Stamp stamp = axes[0]->stamps[i];
      const std::optional<double> y = value_at(*axes[1], stamp, limit);
      const std::optional<double> z = value_at(*axes[2], stamp, limit);
      if (!y || !z) continue;
      rate.stamps.push_back(stamp);
      rate.values.push_back(up.dot(Eigen::Vector3d(axes[0]->values[i], *y, *z)));
    }
    return rate;
  }

  [[nodiscard]] Eigen::Vector3d upward(const std::array<const TimeSeries*, 3>& forces) {
    Eigen::Vector3d standing = Eigen::Vector3d::Zero();
    Eigen::Vector3d all = Eigen::Vector3d::Zero();
    double standing_count = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      double count = 0;
      for (std::size_t k = 0; k < forces[i]->stamps.size(); ++k) {
        const std::optional<double> v = value_at(speed_, forces[i]->stamps[k], kStandstillTime);
        all[static_cast<Eigen::Index>(i)] +=
            forces[i]->values[k] / static_cast<double>(forces[i]->stamps.size());
        if (!v || std::abs(*v) > kStandstillSpeed) continue;
        standing[static_cast<Eigen::Index>(i)] += forces[i]->values[k];
        ++count;
      }
      if (count > 0) standing[static_cast<Eigen::Index>(i)] /= count;
      standing_count = i == 0 ? count : std::min(standing_count, count);
    }
    const bool stood = standing_count * median_interval_s(*forces[0]) >= kStandstillTime;
    const Eigen::Vector3d up = stood ? standing : all;
    if (!(up.norm() > 1))
      throw InputError(
          "odometry: the accelerometer shows no gravity (below 1 m/s^2); check its unit. If the "
          "device removes gravity, state 'gyro: {axis: x}' or another axis");
    note(fmt::format("up is ({:.3f}, {:.3f}, {:.3f}) of the sensor's axes, by {}", up.x() / up.norm(),
                     up.y() / up.norm(), up.z() / up.norm(),
                     stood ? "gravity at standstill" : "the mean specific force (no standstill of 2 s)"));
    return up.normalized();
  }

  [[nodiscard]] std::optional<TimeSeries> steering() const {
    const TimeSeries* angle = find("steering_angle");
    if (angle == nullptr) return std::nullopt;
    const double wheelbase = needed(how_.wheelbase_m, "wheelbase", "steering");
    return combined(*angle, speed_, gap_s_,
                    [&](double a, double v) { return v * std::tan(a / how_.steering_ratio) / wheelbase; });
  }

  /// Gives a speed without a sign the sign of the channel `reverse`; its last reading is valid
  /// until the next.
  void flip_in_reverse() {
    const TimeSeries* reverse = find("reverse");
    if (reverse == nullptr) return;
    std::size_t flipped = 0;
    for (std::size_t i = 0; i < speed_.stamps.size(); ++i) {
      const auto after = std::upper_bound(reverse->stamps.begin(), reverse->stamps.end(), speed_.stamps[i]);
      if (after == reverse->stamps.begin()) continue;
      const auto last = static_cast<std::size_t>(after - reverse->stamps.begin()) - 1;
      if (reverse->values[last] == 0 || speed_.values[i] <= 0) continue;
      speed_.values[i] = -speed_.values[i];
      ++flipped;
    }
    note(fmt::format("{} readings of speed are negative by 'reverse'", flipped));
  }

  /// Returns t if the series has a value then, else its next stamp; its last one is followed by nothing.
  static std::int64_t next_known(const TimeSeries& series, std::int64_t t, double gap_s) {
    if (value_at(series, {t}, gap_s)) return t;
    const auto next = std::upper_bound(series.stamps.begin(), series.stamps.end(), Stamp{t});
    return next == series.stamps.end() ? series.stamps.back().nanoseconds + 1 : next->nanoseconds;
  }

  void sample(const TimeSeries& yaw) {
    const double rate = how_.rate_hz > 0 ? how_.rate_hz : std::min(kLargestRate, 1 / median_interval_s(yaw));
    const auto period = static_cast<std::int64_t>(std::llround(1e9 / rate));
    const std::int64_t first = std::max(speed_.stamps.front(), yaw.stamps.front()).nanoseconds;
    const std::int64_t last = std::min(speed_.stamps.back(), yaw.stamps.back()).nanoseconds;
    const double speed_gap = longest_silence_s(speed_, gap_s_);
    const double yaw_gap = longest_silence_s(yaw, gap_s_);
    const SeriesIntegral way(speed_);
    const SeriesIntegral turn(yaw);
    const SeriesIntegral turn_error(turn_variance_);
    std::int64_t t = first - first % period;
    if (t < first) t += period;
    for (; t <= last; t += period) {
      // a silence may be of years if a single stamp is wrong
      const std::int64_t known = std::max(next_known(speed_, t, speed_gap), next_known(yaw, t, yaw_gap));
      if (known > t) {
        t += ((known - t - 1) / period) * period;
        continue;
      }
      const Stamp from{std::max(t - period / 2, first)};
      const Stamp to{std::min(t - period / 2 + period, last)};
      const double yaw_rate = yaw_is_turn_ ? mean_slope(yaw, from, to) : turn.mean(from, to);
      result_.samples.push_back({.stamp = {t},
                                 .speed_mps = way.mean(from, to),
                                 .yaw_rate_radps = yaw_rate,
                                 .turn_variance_per_s = turn_error.mean(from, to)});
    }
    if (result_.samples.empty())
      throw InputError(
          "odometry: speed and yaw rate do not overlap in time; check 'time: {scale, "
          "week, offset}' of the parts");
    warn_of_silence(1 / rate);
    note(fmt::format("{} samples at {:.4g} Hz{}", result_.samples.size(), rate,
                     how_.rate_hz > 0 ? "" : " (the rate of the yaw rate; state 'rate' for another)"));
  }

  /// A course is only known while the receiver moves.
  void warn_of_silence(double period_s) {
    const double span_s = seconds_between(speed_.stamps.front(), speed_.stamps.back());
    const double share = static_cast<double>(result_.samples.size()) * period_s / span_s;
    if (share >= 0.5) return;
    result_.warnings.push_back(fmt::format(
        "odometry: the yaw rate from '{}' is known in {:.1f} % of the {:.0f} s of speed, and the rest is a gap; "
        "name a source that measures all the time by 'yaw_rate_from', a gyro or a heading (channels found: {})",
        result_.yaw_rate_from, 100 * share, span_s, present()));
  }

  Channels channels_;
  Names by_default_;
  const OdometryAssembly& how_;
  double gap_s_;
  TimeSeries speed_;
  bool yaw_is_turn_ = false;             ///< the source of the yaw rate is a direction
  TimeSeries turn_variance_{{{}}, {0}};  ///< rad^2/s
  AssembledOdometry result_;
};

}  // namespace

bool is_from_wheels_or_steering(std::string_view source) {
  return source == "rear_wheels" || source == "rear_ticks" || source == "steering";
}

AssembledOdometry assemble_odometry(std::span<const OdometryPart> parts, const OdometryAssembly& how,
                                    double gap_s) {
  Names by_default;
  Channels channels = collect_channels(parts, by_default);
  return Assembler(std::move(channels), std::move(by_default), how, gap_s).run();
}

}  // namespace waymark::drive
