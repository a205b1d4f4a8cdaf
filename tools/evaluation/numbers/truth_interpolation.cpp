#include <waymark/tools/evaluation/numbers/truth_interpolation.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/stamp_text.hpp>
#include <waymark/tools/evaluation/numbers/metrics.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::evaluation {
namespace {

void check(const TruthOptions& options) {
  if (!(options.max_gap_factor >= 1) || !std::isfinite(options.max_gap_factor))
    throw UsageError(
        fmt::format("max_gap_factor: got {}, must be finite and at least 1", options.max_gap_factor));
  if (!(options.direction_span_s >= 0))
    throw UsageError(fmt::format("direction_span_s: got {}, must not be negative", options.direction_span_s));
  if (!(options.min_direction_speed_mps > 0))
    throw UsageError(
        fmt::format("min_direction_speed_mps: got {}, must be positive", options.min_direction_speed_mps));
}

void check_order(std::span<const TruthPose> truth) {
  if (truth.empty()) throw InputError("truth: no pose in it");
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (!truth[i].position.allFinite() || !std::isfinite(truth[i].heading_rad.value_or(0)))
      throw InputError(fmt::format("truth: pose {} at {} s is not finite", i + 1,
                                   formats::decimal_seconds(truth[i].stamp)));
    if (i > 0 && truth[i].stamp < truth[i - 1].stamp)
      throw InputError(fmt::format("truth: pose {} at {} s is earlier than the one before it at {} s", i + 1,
                                   formats::decimal_seconds(truth[i].stamp),
                                   formats::decimal_seconds(truth[i - 1].stamp)));
  }
}

double median_interval_s(std::span<const TruthPose> truth) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const double interval = seconds_between(truth[i - 1].stamp, truth[i].stamp);
    if (interval > 0) intervals.push_back(interval);
  }
  return intervals.empty() ? kUndefined : upper_median(std::move(intervals));
}

/// The truth and facts about its sampling.
struct SampledTruth {
  std::span<const TruthPose> poses;
  double longest_interval_s;
  const TruthOptions& options;

  /// Tells whether the interval after pose `i` exists and is no gap. NaN (one pose) compares false.
  [[nodiscard]] bool joined(std::size_t i) const {
    return i + 1 < poses.size() && seconds_between(poses[i].stamp, poses[i + 1].stamp) <= longest_interval_s;
  }
};

/// Returns the direction of the chord around poses [first, last]. The chord is widened alternately
/// on both sides up to the requested span.
std::optional<double> direction_around(const SampledTruth& truth, std::size_t first, std::size_t last) {
  const auto& poses = truth.poses;
  const auto span_s = [&] { return seconds_between(poses[first].stamp, poses[last].stamp); };
  bool widened = true;
  while (widened && (first == last || span_s() < truth.options.direction_span_s)) {
    widened = false;
    if (first > 0 && truth.joined(first - 1)) {
      --first;
      widened = true;
    }
    if (truth.joined(last)) {
      ++last;
      widened = true;
    }
  }
  const Eigen::Vector2d chord = poses[last].position - poses[first].position;
  const bool moving = span_s() > 0 && chord.norm() >= truth.options.min_direction_speed_mps * span_s();
  if (!moving) return std::nullopt;
  return std::atan2(chord.y(), chord.x());
}

TruthPose interpolate(const TruthPose& a, const TruthPose& b, Stamp epoch) {
  const double share = seconds_between(a.stamp, epoch) / seconds_between(a.stamp, b.stamp);
  TruthPose pose{.stamp = epoch,
                 .position = a.position + share * (b.position - a.position),
                 .heading_rad = {},
                 .height_m = a.height_m + share * (b.height_m - a.height_m)};
  if (a.heading_rad && b.heading_rad)
    pose.heading_rad = wrap_angle(*a.heading_rad + share * wrap_angle(*b.heading_rad - *a.heading_rad));
  return pose;
}

std::optional<TruthAtEpoch> truth_at(const SampledTruth& truth, Stamp epoch) {
  const auto& poses = truth.poses;
  const auto later = std::upper_bound(poses.begin(), poses.end(), epoch,
                                      [](Stamp stamp, const TruthPose& pose) { return stamp < pose.stamp; });
  if (later == poses.begin()) return std::nullopt;
  const auto before = static_cast<std::size_t>(later - poses.begin()) - 1;
  if (poses[before].stamp == epoch)
    return TruthAtEpoch{.pose = poses[before], .direction_rad = direction_around(truth, before, before)};
  if (!truth.joined(before)) return std::nullopt;
  return TruthAtEpoch{.pose = interpolate(poses[before], poses[before + 1], epoch),
                      .direction_rad = direction_around(truth, before, before + 1)};
}

[[noreturn]] void throw_no_match(std::span<const TruthPose> truth, std::span<const Stamp> epochs,
                                 const TruthMatch& match) {
  const auto [first, last] = std::minmax_element(epochs.begin(), epochs.end());
  const std::string spans =
      fmt::format("truth spans {} .. {} s, the fixes {} .. {} s",
                  formats::decimal_seconds(truth.front().stamp), formats::decimal_seconds(truth.back().stamp),
                  formats::decimal_seconds(*first), formats::decimal_seconds(*last));
  if (match.in_gap == 0)
    throw InputError("truth does not overlap the drive in time: " + spans +
                     "; check that both are on one time scale (GPS, UTC)");
  throw InputError(fmt::format(
      "no fix could be matched to truth: {} of {} are in gaps of the truth longer than {:.3f} s; {}",
      match.in_gap, epochs.size(), match.longest_interpolated_s, spans));
}

}  // namespace

TruthMatch interpolate_truth(std::span<const TruthPose> truth, std::span<const Stamp> epochs,
                             const TruthOptions& options) {
  check(options);
  check_order(truth);
  TruthMatch match;
  match.median_interval_s = median_interval_s(truth);
  // A microsecond is added: 1.5 x 0.2 s must be allowed if rounded stamps say 0.3 s.
  match.longest_interpolated_s = options.max_gap_factor * match.median_interval_s + 1e-6;
  const SampledTruth sampled{
      .poses = truth, .longest_interval_s = match.longest_interpolated_s, .options = options};

  match.at.reserve(epochs.size());
  for (const Stamp epoch : epochs) {
    match.at.push_back(truth_at(sampled, epoch));
    if (match.at.back())
      ++match.matched;
    else if (epoch < truth.front().stamp)
      ++match.before_truth;
    else if (epoch > truth.back().stamp)
      ++match.after_truth;
    else
      ++match.in_gap;
  }
  if (match.matched == 0 && !epochs.empty()) throw_no_match(truth, epochs, match);
  return match;
}

std::vector<TruthPose> truth_from_poses(std::span<const StampedPose> poses) {
  std::vector<TruthPose> truth;
  truth.reserve(poses.size());
  for (const StampedPose& pose : poses)
    truth.push_back(
        TruthPose{.stamp = pose.stamp, .position = pose.pose.head<2>(), .heading_rad = pose.pose[2]});
  return truth;
}

}  // namespace waymark::evaluation
