#include <waymark/tools/live/estimator/intake.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace waymark::live {
namespace {

constexpr double kFuture = 60;         // s: a stamp that is further ahead of the odometry cannot be
constexpr std::size_t kConvinced = 3;  // so many samples in a row tell that the clock has jumped
constexpr double kLeastStep_s = 1;     // of the clock of the odometry alone
constexpr std::size_t kMostWaiting = 100'000;

bool is_finite(const OdometrySample& sample) {
  return std::isfinite(sample.speed_mps) && std::isfinite(sample.yaw_rate_radps);
}
bool is_finite(const GeodeticFix& fix) {
  return std::isfinite(fix.latitude_deg) && std::isfinite(fix.longitude_deg) && fix.covariance_en.allFinite();
}
bool is_finite(const SensorReading&) {
  return true;  // NaN stands for a value that a row does not have
}

bool is_finite(const FurtherOdometry& sample) {
  return std::isfinite(sample.speed_mps) && std::isfinite(sample.yaw_rate_radps);
}

bool have_same_values(const SensorReading& a, const SensorReading& b) {
  return std::equal(a.values.begin(), a.values.end(), b.values.begin(), b.values.end(),
                    [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

std::size_t order_of(const Sample& sample) {
  if (std::holds_alternative<OdometrySample>(sample)) return 0;
  if (const auto* further = std::get_if<FurtherOdometry>(&sample)) return 500 + further->source;
  if (const auto* reading = std::get_if<SensorReading>(&sample)) return 1 + reading->sensor;
  return 1000 + static_cast<std::size_t>(std::get<GeodeticFix>(sample).source);
}

}  // namespace

Stamp stamp_of(const Sample& sample) {
  return std::visit([](const auto& of) { return of.stamp; }, sample);
}

// An epoch of a sensor may be several rows of one stamp, a satellite in each.
bool Intake::is_duplicate(const Sample& sample, std::size_t order) const {
  const Stamp stamp = stamp_of(sample);
  const auto* reading = std::get_if<SensorReading>(&sample);
  return std::any_of(waiting_.begin(), waiting_.end(), [&](const Waiting& other) {
    return other.stamp == stamp && other.order == order &&
           (reading == nullptr || have_same_values(*reading, std::get<SensorReading>(other.sample)));
  });
}

void Intake::insert(Sample sample, std::size_t order) {
  const Stamp stamp = stamp_of(sample);
  const auto place = std::upper_bound(waiting_.begin(), waiting_.end(), std::pair(stamp, order),
                                      [](const std::pair<Stamp, std::size_t>& own, const Waiting& other) {
                                        return own < std::pair(other.stamp, other.order);
                                      });
  waiting_.insert(place, Waiting{std::move(sample), stamp, order});
}

bool Intake::is_plausible(double ahead_s) const {
  return ahead_s <= longest_gap_s_ && ahead_s > -std::max(1.0, reorder_s_);
}

/// Tells whether the odometry was silent so long that fixes should have come, and none has: its clock may have stepped.
bool Intake::is_silence(double ahead_s) const {
  constexpr double kIntervals = 1.5;
  if (ahead_s <= kLeastStep_s || ahead_s <= 5 * interval_s_ || relation_.fixes_since_odometry() > 0)
    return false;
  const std::optional<double> within_s = relation_.next_fix_within_s(*newest_);
  return within_s && ahead_s > kIntervals * *within_s;
}

Arrival Intake::take_odometry(OdometrySample sample) {
  sample.stamp.nanoseconds += moved_ns_;
  const double ahead_s = newest_ ? seconds_between(*newest_, sample.stamp) : 0;
  if (newest_ && (!is_plausible(ahead_s) || is_silence(ahead_s))) return suspend(sample);
  suspended_.clear();
  relation_.take_odometry();
  if (released_odometry_ && sample.stamp <= *released_odometry_)
    return sample.stamp == *released_odometry_ ? Arrival::duplicate : Arrival::late;
  if (is_duplicate(sample, 0)) return Arrival::duplicate;
  insert(sample, 0);
  if (ahead_s > 0) interval_s_ = ahead_s;
  newest_ = newest_ ? std::max(*newest_, sample.stamp) : sample.stamp;
  newest_of_first_ = newest_of_first_ ? std::max(*newest_of_first_, sample.stamp) : sample.stamp;
  return Arrival::taken;
}

// A step of the clock is believed when some samples in a row follow one another on the new one.
Arrival Intake::suspend(const OdometrySample& sample) {
  if (!suspended_.empty()) {
    const double step_s = seconds_between(suspended_.back().stamp, sample.stamp);
    if (step_s <= 0 && is_plausible(step_s)) return step_s == 0 ? Arrival::duplicate : Arrival::late;
    if (step_s <= 0 || step_s > longest_gap_s_) suspended_.clear();
  }
  if (suspended_.empty()) told_s_.reset();
  suspended_.push_back(sample);
  decide();
  return suspended_.empty() ? Arrival::taken : Arrival::suspended;
}

/// Tells whether a fix should come soon, which tells whose clock has stepped.
bool Intake::waits_for_fix() const {
  constexpr double kIntervals = 1.5;
  constexpr double kMore_s = 1;
  constexpr double kLongest_s = 12;
  const std::optional<double> within_s = relation_.next_fix_within_s(*newest_);
  return within_s && seconds_between(suspended_.front().stamp, suspended_.back().stamp) <
                         std::min(kLongest_s, kIntervals * *within_s + kMore_s);
}

// If only the clock of the odometry has stepped, the fix is as late as usual on the clock before: that goes on from the
// last sample by an interval, and by more if the odometry was silent as well.
void Intake::hear(const GeodeticFix& fix) {
  constexpr double kLikely = 0.25;  // of the step
  constexpr double kSilence_s = 0.3;
  if (!newest_) return;
  const std::optional<double> usual_s = relation_.usual_lateness_s(fix.source);
  if (suspended_.empty()) return relation_.take_fix(fix.source, fix.stamp, *newest_);
  if (told_s_ || !usual_s) return;
  const double step_s =
      seconds_between(newest_of_first_.value_or(*newest_), suspended_.front().stamp) - interval_s_;
  const double late_s = seconds_between(fix.stamp, suspended_.back().stamp) - step_s - *usual_s;
  const bool alone = std::abs(late_s) < kLikely * std::abs(step_s);
  told_s_ = alone ? -step_s + (late_s < -kSilence_s ? -late_s : 0) : 0;
  decide();
}

void Intake::decide() {
  if (suspended_.size() < kConvinced || (!told_s_ && waits_for_fix())) return;
  const double moved_s = told_s_.value_or(0);
  told_s_.reset();
  if (moved_s == 0 && !is_plausible(seconds_between(*newest_, suspended_.front().stamp)))
    return begin_at_suspended();
  if (moved_s != 0) step_s_ = -moved_s;
  take_suspended(moved_s);
}

void Intake::take_suspended(double moved_s) {
  const std::int64_t moved_ns = std::llround(moved_s * 1e9);
  moved_ns_ += moved_ns;
  for (OdometrySample& kept : std::exchange(suspended_, {})) {
    kept.stamp.nanoseconds += moved_ns;
    insert(kept, 0);
    newest_ = std::max(*newest_, kept.stamp);
    newest_of_first_ = kept.stamp;
  }
  relation_.take_odometry();
}

void Intake::begin_at_suspended() {
  jump_ = ClockJump{*newest_, suspended_.front().stamp};
  // What waits on the old clock is of no use; what was too early for it may be of the new one.
  std::erase_if(waiting_, [&](const Waiting& other) { return other.order == 0 || other.stamp < jump_->to; });
  late_.clear();
  released_.reset();
  released_odometry_.reset();
  relation_.forget();
  newest_ = newest_of_first_ = suspended_.back().stamp;
  for (const OdometrySample& kept : std::exchange(suspended_, {})) insert(kept, 0);
}

/// Begins anew on the clock of the fixes.
void Intake::move_to_fixes(double moved_s) {
  jump_ = ClockJump{*newest_, newest_->later(moved_s), true};
  moved_ns_ += std::llround(moved_s * 1e9);
  waiting_.clear();
  late_.clear();
  suspended_.clear();
  released_.reset();
  released_odometry_.reset();
  relation_.forget();
  newest_ = newest_of_first_ = jump_->to;
}

void Intake::finish() {
  finished_ = true;
  if (!suspended_.empty() && is_plausible(seconds_between(*newest_, suspended_.front().stamp)))
    take_suspended(0);
}

// A further odometry keeps the time going while the first one is silent, but no stamp of it moves the clock by
// more than a gap.
Arrival Intake::take_further(FurtherOdometry sample) {
  if (newest_) {
    double ahead_s = seconds_between(*newest_, sample.stamp);
    Stamp moved = sample.stamp;
    moved.nanoseconds += moved_ns_;
    // It may have the clock of the first one, which has stepped.
    if (!is_plausible(ahead_s) && is_plausible(seconds_between(*newest_, moved))) {
      sample.stamp = moved;
      ahead_s = seconds_between(*newest_, moved);
    }
    if (ahead_s > longest_gap_s_) return Arrival::future;
    if (ahead_s <= -std::max(1.0, reorder_s_)) return Arrival::late;
  }
  const std::size_t order = order_of(sample);
  if (is_duplicate(sample, order)) return Arrival::duplicate;
  insert(sample, order);
  newest_ = newest_ ? std::max(*newest_, sample.stamp) : sample.stamp;
  return Arrival::taken;
}

Arrival Intake::take(Sample sample) {
  if (!std::visit([](const auto& of) { return is_finite(of); }, sample)) return Arrival::not_finite;
  if (const auto* odometry = std::get_if<OdometrySample>(&sample)) return take_odometry(*odometry);
  if (const auto* further = std::get_if<FurtherOdometry>(&sample)) return take_further(*further);
  if (const auto* fix = std::get_if<GeodeticFix>(&sample)) {
    hear(*fix);
    if (const std::optional<double> apart_s = relation_.apart_s()) move_to_fixes(*apart_s);
  }
  const Stamp stamp = stamp_of(sample);
  const std::size_t order = order_of(sample);
  if (newest_ && seconds_between(*newest_, stamp) > kFuture) return Arrival::future;
  if (is_duplicate(sample, order)) return Arrival::duplicate;
  const bool is_row = std::holds_alternative<SensorReading>(sample);  // others of its epoch may be released
  if (released_ && (is_row ? stamp < *released_ : stamp <= *released_)) {
    if (std::holds_alternative<GeodeticFix>(sample)) late_.push_back(std::move(sample));
    return Arrival::late;
  }
  insert(std::move(sample), order);
  if (waiting_.size() > kMostWaiting) waiting_.pop_front();
  return Arrival::taken;
}

std::optional<ClockJump> Intake::jump() {
  return std::exchange(jump_, std::nullopt);
}

// A fix waits for the odometry around it: an odometry sample of the same stamp or a later one.
std::optional<Sample> Intake::next() {
  if (!late_.empty()) {
    Sample sample = std::move(late_.front());
    late_.pop_front();
    return sample;
  }
  if (waiting_.empty() || (!finished_ && !newest_)) return std::nullopt;
  if (!finished_ && seconds_between(waiting_.front().stamp, *newest_) < reorder_s_) return std::nullopt;
  Waiting first = std::move(waiting_.front());
  waiting_.pop_front();
  released_ = released_ ? std::max(*released_, first.stamp) : first.stamp;
  if (first.order == 0) released_odometry_ = first.stamp;
  return std::move(first.sample);
}

}  // namespace waymark::live
