#include <waymark/tools/live/estimator/guards/speed_guard.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/tools/drive/mending/speed_leaps.hpp>

namespace waymark::live {
namespace {

constexpr std::size_t kChanges = 3000;  // for what is usual
constexpr double kSilence_s = 1;        // a longer one has nothing to compare with
constexpr double kFrozen_s = 5;         // a speed that leaps after it has repeated itself was wrong before
constexpr double kRare = 20;

}  // namespace

void SpeedGuard::remember(const OdometrySample& sample) {
  if (!recent_.empty()) {
    const double dt_s = seconds_between(recent_.back().stamp, sample.stamp);
    if (dt_s > kSilence_s) {
      recent_.clear();
    } else {
      seen_s_ += dt_s;
      const double change = std::abs(sample.speed_mps - recent_.back().speed_mps);
      if (std::abs(sample.speed_mps) > drive::kLeastLeap_mps) changes_.push_back(change);
      if (changes_.size() > kChanges) changes_.pop_front();
    }
  }
  if (recent_.empty() || recent_.back().speed_mps != sample.speed_mps) changed_ = sample.stamp;
  recent_.push_back(sample);
  // One sample that is older stays: the interval may be longer than a leap.
  while (recent_.size() > 2 && seconds_between(recent_[1].stamp, sample.stamp) > drive::kLeapTakes_s)
    recent_.pop_front();
}

double SpeedGuard::usual_change() const {
  if (changes_.empty()) return 0;
  return 1.4826 * upper_median(std::vector<double>(changes_.begin(), changes_.end()));
}

std::optional<OdometrySample> SpeedGuard::leapt_from(const OdometrySample& sample) const {
  std::optional<double> usual;
  for (auto from = recent_.rbegin(); from != recent_.rend(); ++from) {
    const double time_s = seconds_between(from->stamp, sample.stamp);
    const double change = sample.speed_mps - from->speed_mps;
    if (time_s > kSilence_s) break;
    if (!drive::is_speed_leap(change, time_s, 0)) continue;
    if (!usual) usual = usual_change();
    if (drive::is_speed_leap(change, time_s, *usual)) return *from;
  }
  return std::nullopt;
}

bool SpeedGuard::is_back(const OdometrySample& sample, const OdometrySample& from) const {
  const double change = sample.speed_mps - from.speed_mps;
  const bool against = change * (from.speed_mps - before_->speed_mps) < 0;
  return against && drive::is_possible_change(sample.speed_mps - before_->speed_mps,
                                              seconds_between(before_->stamp, sample.stamp));
}

bool SpeedGuard::has_repeated(const OdometrySample& sample) const {
  return changed_ && seconds_between(*changed_, sample.stamp) > kFrozen_s;
}

/// Tells whether a leap that was taken for the vehicle's speed comes back at last.
bool SpeedGuard::is_late_return(const OdometrySample& sample, const OdometrySample& from) const {
  return given_up_ * (sample.speed_mps - from.speed_mps) < 0;
}

bool SpeedGuard::is_rough() const {
  return held_s_ > std::max(drive::kLeapLasts_s, seen_s_ / kRare);
}

OdometrySample SpeedGuard::judged(OdometrySample sample) {
  if (!recent_.empty() && sample.stamp <= recent_.back().stamp) return sample;
  const std::optional<OdometrySample> from = leapt_from(sample);
  const bool is_on_its_way =
      back_ && seconds_between(*back_, sample.stamp) <= drive::kLeapTakes_s;  // of the leap back
  if (before_) {
    const bool ends = seconds_between(before_->stamp, sample.stamp) > drive::kLeapLasts_s;
    if (ends || (from && is_back(sample, *from))) {
      given_up_ = ends ? sample.speed_mps - before_->speed_mps : 0;
      before_.reset();
      recent_.clear();
      back_ = sample.stamp;
    }
  } else if (from && is_late_return(sample, *from)) {
    given_up_ = 0;
    recent_.clear();
    back_ = sample.stamp;
  } else if (from && (is_on_its_way || has_repeated(sample))) {
    recent_.clear();
  } else if (from) {
    before_ = from;
  }
  if (before_ && !recent_.empty()) held_s_ += seconds_between(recent_.back().stamp, sample.stamp);
  if (is_rough()) before_.reset();
  remember(sample);
  if (before_) {
    sample.speed_mps = before_->speed_mps;
    sample.assumed = true;
  }
  return sample;
}

}  // namespace waymark::live
