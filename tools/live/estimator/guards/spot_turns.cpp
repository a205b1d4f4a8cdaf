#include <waymark/tools/live/estimator/guards/spot_turns.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <waymark/tools/drive/nodes/yaw_rate_at_rest.hpp>

namespace waymark::live {
namespace {

constexpr double kWindow_s = 1;
constexpr double kFewestCalm = 5;
constexpr double kLongestTurn_s = 120;

}  // namespace

/// Readings that have left the window at rest tell the bias; old ones count less and less.
void SpotTurns::keep_calm(const OdometrySample& sample) {
  constexpr double kRemembered = 1000;
  calm_count_ = std::min(calm_count_ + 1, kRemembered);
  calm_ += (sample.yaw_rate_radps - calm_) / calm_count_;
}

double SpotTurns::clear_radps() const {
  constexpr double kClear_radps = 0.015;
  constexpr double kDeviations = 5;
  return std::max(kClear_radps, kDeviations * std::sqrt(noise_ / static_cast<double>(window_.size())));
}

/// Returns the turn in the window against the standing before, rad, and its rate.
std::pair<double, double> SpotTurns::turn_in_window() const {
  double turned_rad = 0;
  double seconds = 0;
  for (std::size_t i = 1; i < window_.size(); ++i) {
    const double step_s = seconds_between(window_[i - 1].stamp, window_[i].stamp);
    turned_rad += (window_[i].yaw_rate_radps - calm_) * step_s;
    seconds += step_s;
  }
  return {turned_rad, seconds > 0 ? turned_rad / seconds : 0};
}

/// What was taken for standing was a turn: it has ended, and nothing else turns for so long.
void SpotTurns::forget_calm() {
  calm_count_ = 0;
  turns_ = false;
  missed_rad_ = 0;
}

OdometrySample SpotTurns::judged(OdometrySample sample) {
  double step_s = window_.empty() ? 0 : seconds_between(window_.back().stamp, sample.stamp);
  const bool follows = step_s > 0 && step_s <= kWindow_s;
  if (!drive::is_at_rest(sample) || !follows) {
    window_.clear();
    turns_ = false;
    step_s = 0;
  }
  if (!drive::is_at_rest(sample)) return sample;
  if (!window_.empty()) {
    const double difference = sample.yaw_rate_radps - window_.back().yaw_rate_radps;
    differences_ = std::min(differences_ + 1, 1000.0);
    noise_ += (0.5 * difference * difference - noise_) / differences_;
  }
  window_.push_back(sample);
  while (seconds_between(window_.front().stamp, sample.stamp) > kWindow_s) {
    if (!turns_) keep_calm(window_.front());
    window_.pop_front();
  }
  if (calm_count_ < kFewestCalm || step_s <= 0) return sample;
  const auto [turned_rad, rate] = turn_in_window();
  const bool turned = turns_;
  turns_ = std::abs(rate) > (turned ? 0.5 : 1) * clear_radps();
  if (turns_ && !turned) turns_since_ = sample.stamp;
  if (turns_ && seconds_between(turns_since_, sample.stamp) > kLongestTurn_s) forget_calm();
  sample.turns_on_spot = turns_;
  if (turns_ && !turned) missed_rad_ = turned_rad;
  // It counts in the interval before it and in the next one, each by half.
  const double usual_s =
      seconds_between(window_.front().stamp, sample.stamp) / static_cast<double>(window_.size() - 1);
  if (turns_ && turned) sample.yaw_rate_radps += std::exchange(missed_rad_, 0) / (0.5 * (step_s + usual_s));
  return sample;
}

}  // namespace waymark::live
