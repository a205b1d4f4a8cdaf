#include <waymark/tools/live/estimator/estimator.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <waymark/core/base/angle.hpp>
#include <waymark/core/base/detail/median.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/model/surroundings.hpp>
#include <waymark/tools/drive/nodes/start.hpp>
#include <waymark/tools/drive/sensors/rough_fixes.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::live {
namespace {

constexpr double kSecondsWithoutFix = 2;  // then a solution moves the window on
constexpr double kLongestStretch = 10;    // s of poses that leave the window together
constexpr double kPlacesFrame_m = 1000;   // a frame is not chosen by a rougher place
constexpr double kRoughStart_s = 30;      // positions of single epochs are wrong alike for many seconds
constexpr double kFixIsOld = 1.5;         // s, unless fixes usually are rarer
constexpr double kLooksBack = 60;         // s, for the alignment
constexpr std::size_t kClaims = 300;

Pose2<double> to_pose(const Eigen::Vector3d& numbers) {
  return {numbers[0], numbers[1], numbers[2]};
}

Eigen::Vector3d way_of(const Interval& interval, double standstill_mps) {
  if (std::abs(interval.speed_mps) < standstill_mps) return Eigen::Vector3d::Zero();
  return {interval.speed_mps * interval.dt_s, 0, interval.yaw_rate_radps * interval.dt_s};
}

Eigen::Vector3d moved(const Eigen::Vector3d& from, const Eigen::Vector3d& way) {
  return compose(to_pose(from), se2_exp(way)).vector();
}

}  // namespace

std::string_view to_string(State state) {
  switch (state) {
    case State::waiting:
      return "waiting";
    case State::aligning:
      return "aligning";
    case State::tracking:
      return "tracking";
    case State::dead_reckoning:
      return "dead_reckoning";
    case State::degraded:
      return "degraded";
    case State::lost:
      return "lost";
  }
  return "";
}

Estimator::Estimator(drive::DriveDescription description, const drive::FusionSettings& settings,
                     const LiveSettings& live, const TypeRegistry& registry)
    : description_(std::move(description)),
      settings_(drive::decided(settings, registry)),
      live_(live),
      registry_(registry),
      intake_(live.reorder_s, live.longest_gap_s),
      odometries_(description_.odometry.size(), description_.timeline.gap_s),
      rough_(description_, registry) {
  if (description_.odometry.empty()) throw UsageError("live fusion needs an odometry");
  if (description_.gnss.empty() && !rough_.any())
    throw UsageError("live fusion needs a receiver, or a sensor that places the vehicle");
  standstill_mps_ =
      drive::make_odometry_model(drive::for_relative(settings_, description_.odometry.front().name),
                                 description_.timeline.gap_noise_factor, registry_)
          ->standstill_speed();
}

Estimator::~Estimator() = default;

void Estimator::begin_with(const WarmStart& start) {
  warm_ = start;
  if (start.frame.zone != 0 && !frame_) {
    frame_ = start.frame;
    projection_.emplace(*frame_);
  }
}

std::string Estimator::source_of(const Sample& sample) const {
  if (std::holds_alternative<OdometrySample>(sample)) return description_.odometry.front().name;
  if (const auto* further = std::get_if<FurtherOdometry>(&sample))
    return description_.odometry[further->source].name;
  if (const auto* reading = std::get_if<SensorReading>(&sample)) {
    const drive::SensorConfig& sensor = description_.sensors[reading->sensor];
    return sensor.source.empty() ? sensor.name : sensor.source;
  }
  return description_.gnss[static_cast<std::size_t>(std::get<GeodeticFix>(sample).source)].name;
}

void Estimator::say(const std::string& kind, const std::string& source, const std::string& text) {
  reports_.emplace_back(Event{now_, kind, source, text});
}

void Estimator::refuse(const Sample& sample, const std::string& reason, const std::string& text) {
  const std::string source = source_of(sample);
  std::size_t& count = counts_.refused[source + ": " + reason];
  ++count;
  // Repetitions fill no log: the first one is told, and then every power of ten.
  const double power = std::log10(static_cast<double>(count));
  if (power == std::floor(power))
    say(reason, source, count == 1 ? text : fmt::format("{} (so far {} times)", text, count));
}

void Estimator::take(Sample sample) {
  if (auto* odometry = std::get_if<OdometrySample>(&sample)) {
    odometry->stamp = odometry->stamp.later(-description_.odometry.front().speed_delay_s);
  } else if (auto* further = std::get_if<FurtherOdometry>(&sample)) {
    if (further->source == 0 || further->source >= description_.odometry.size())
      throw UsageError("a sample names the odometry " + std::to_string(further->source) +
                       ", which is no further one");
    further->stamp = further->stamp.later(-description_.odometry[further->source].speed_delay_s);
  } else if (auto* fix = std::get_if<GeodeticFix>(&sample)) {
    if (fix->source < 0 || static_cast<std::size_t>(fix->source) >= description_.gnss.size())
      throw UsageError("a fix names the receiver " + std::to_string(fix->source) + ", which does not exist");
    fix->stamp = fix->stamp.later(-description_.gnss[static_cast<std::size_t>(fix->source)].delay_s);
  }
  const Sample copy = sample;
  switch (intake_.take(std::move(sample))) {
    case Arrival::taken:
    case Arrival::suspended:
      break;
    case Arrival::late:
      if (std::holds_alternative<GeodeticFix>(copy)) break;
      refuse(copy, "late", "a sample is older than others that were used already");
      break;
    case Arrival::duplicate:
      refuse(copy, "duplicate", "a sample repeats the stamp of another one");
      break;
    case Arrival::not_finite:
      refuse(copy, "not_finite", "a sample has a number that is not finite");
      break;
    case Arrival::future:
      refuse(copy, "future",
             fmt::format("a sample is stamped {:.1f} s after the odometry",
                         seconds_between(now_, stamp_of(copy))));
      break;
  }
  // Without odometry time stands still, but fixes still tell where the vehicle is.
  const auto* fix = std::get_if<GeodeticFix>(&copy);
  const bool silent = !odometry_.empty() && seconds_between(now_, stamp_of(copy)) > live_.silence_s;
  if (fix != nullptr && std::isfinite(fix->latitude_deg) && std::isfinite(fix->longitude_deg) &&
      (odometry_.empty() || silent)) {
    if (silent) change_state(State::lost, fmt::format("no odometry for {:.1f} s", live_.silence_s));
    Fix place = projected(*fix);
    publish_place(place);
  }
  work();
}

void Estimator::finish() {
  intake_.finish();
  work();
  use_pending();
  if (!window_) return;
  for (const StampedPose& pose : window_->remaining())
    reports_.emplace_back(SettledPose{pose.stamp, pose.pose, counts_.resets});
}

std::vector<Report> Estimator::reports() {
  return std::exchange(reports_, {});
}

void Estimator::work() {
  if (const std::optional<ClockJump> jump = intake_.jump()) {
    reset("jump", fmt::format("the clock of the odometry has jumped by {:.3f} s",
                              seconds_between(jump->from, jump->to)));
    odometry_.clear();
    odometries_.clear();
    fixes_.clear();
    pending_.clear();
    receivers_.clear();
    last_fix_.reset();
  }
  while (std::optional<Sample> sample = intake_.next()) {
    if (const auto* odometry = std::get_if<OdometrySample>(&*sample)) {
      hear(0, *odometry);
    } else if (const auto* further = std::get_if<FurtherOdometry>(&*sample)) {
      hear(further->source, {further->stamp, further->speed_mps, further->yaw_rate_radps});
    } else {
      pending_.push_back(std::move(*sample));
      if (!odometry_.empty() && stamp_of(pending_.back()) <= now_) use_pending();
    }
  }
}

/// Uses the fixes and readings that have odometry on both sides.
void Estimator::use_pending() {
  std::deque<Sample> later;
  for (Sample& sample : std::exchange(pending_, {})) {
    if (stamp_of(sample) > now_) {
      later.push_back(std::move(sample));
    } else if (const auto* fix = std::get_if<GeodeticFix>(&sample)) {
      use(*fix);
    } else {
      use(std::get<SensorReading>(sample));
    }
  }
  for (Sample& sample : later) pending_.push_back(std::move(sample));
}

void Estimator::hear(std::size_t source, const OdometrySample& sample) {
  const std::string& name = description_.odometry[source].name;
  counts_.taken[name] += 1;
  if (!has_several_odometries()) return advance(0, sample);
  if (!odometries_.take(source, sample)) {
    counts_.taken[name] -= 1;
    refuse(FurtherOdometry{sample.stamp, source, 0, 0}, "late",
           "a sample is older than others of its source");
    return;
  }
  const std::optional<Stamp> last = odometry_.empty() ? std::nullopt : std::optional(now_);
  for (const OdometrySample& node : odometries_.nodes(source, last)) {
    const std::size_t before = odometry_.empty() ? source : odometry_.back().giver;
    if (before != source) say("odometry", name, "the nodes come from here now");
    odometries_.made_node(source, node.stamp);
    advance(source, node);
  }
  if (!window_) return;
  for (const MeasuredWay& way : odometries_.ways(window_->stamps(), odometry_.back().giver, grid_scale_))
    window_->add_way(way);
}

void Estimator::advance(std::size_t source, const OdometrySample& sample) {
  const bool first = odometry_.empty();
  if (!first && seconds_between(now_, sample.stamp) > live_.longest_gap_s) {
    reset("reset", fmt::format("no odometry for {:.1f} s", seconds_between(now_, sample.stamp)));
    odometry_.clear();
    fixes_.clear();
  }
  if (odometry_.empty()) {
    odometry_.push_back({sample, source, Eigen::Vector3d::Zero(), 0});
    now_ = sample.stamp;
  } else {
    add_motion(source, sample);
  }
  // A short window is no reason to look back less for the heading.
  const double kept_s = window_ ? live_.window_s + kLongestStretch : std::max(live_.window_s, kLooksBack);
  while (odometry_.size() > 2 && seconds_between(odometry_[1].sample.stamp, now_) > kept_s)
    odometry_.pop_front();
  use_pending();
  use_rough_places();
  if (!window_) {
    const Stamp begin = odometry_.front().sample.stamp;
    while (!fixes_.empty() && fixes_.front().stamp < begin) fixes_.pop_front();
    while (!readings_.empty() && readings_.front().stamp < begin) readings_.pop_front();
    align();
  }
  if (window_ && seconds_between(last_cycle_, now_) >= kSecondsWithoutFix) {
    cycle();
    drop();
  }
  judge_state();
  if (window_) publish(false);
}

// Between two samples the motion is the mean of both. In a gap fixes have nodes of their own, because the
// nearest sample may be seconds away.
void Estimator::add_motion(std::size_t source, const OdometrySample& sample) {
  const Reckoned& last = odometry_.back();
  Interval whole = drive::motion_between(last.sample, sample, grid_scale_, description_.timeline.gap_s);
  if (last.giver != source && !whole.bridged)
    whole = odometries_.between(source, last.sample.stamp, sample.stamp, grid_scale_);
  const Eigen::Vector3d way = way_of(whole, standstill_mps_);
  Reckoned next{sample, source, moved(last.pose, way), last.way_m + std::abs(way[0])};
  std::vector<Stamp> ends;
  if (whole.bridged)
    for (const Sample& waiting : pending_)
      if (stamp_of(waiting) > now_ && stamp_of(waiting) < sample.stamp) ends.push_back(stamp_of(waiting));
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  ends.push_back(sample.stamp);
  for (const Stamp end : ends) {
    Interval part = whole;
    part.dt_s = seconds_between(now_, end);
    now_ = end;
    if (!window_) continue;
    const Eigen::Vector3d before = window_->newest_pose();
    window_->add_node(end, part, whole.bridged ? 0 : source);
    smooth_ = compose(to_pose(smooth_), between(to_pose(before), to_pose(window_->newest_pose()))).vector();
  }
  odometry_.push_back(std::move(next));
}

const drive::Projection& Estimator::projection_at(const GeodeticPoint& place) {
  if (!frame_) {
    frame_ = drive::choose_frame(place, description_.utm_zone, description_.utm_origin);
    projection_.emplace(*frame_);
  }
  return *projection_;
}

Fix Estimator::projected(const GeodeticFix& fix) {
  Fix place = projection_at({fix.latitude_deg, fix.longitude_deg}).project(fix);
  place.told = fix.told;
  place.accuracy_claimed = fix.accuracy_claimed;
  place.antenna_m = settings_.lever_arm ? description_.gnss[static_cast<std::size_t>(fix.source)].antenna_m
                                        : Eigen::Vector2d(0, 0);
  return place;
}

bool Estimator::is_thinned(const GeodeticFix& fix) {
  const double period_s = description_.gnss[static_cast<std::size_t>(fix.source)].period_s;
  if (!(period_s > 0)) return false;
  const auto multiple = static_cast<std::int64_t>(std::llround(fix.stamp.seconds() / period_s));
  std::optional<std::int64_t>& last = receivers_[fix.source].period;
  if (last && multiple <= *last) return true;
  last = multiple;
  return false;
}

Estimator::Reckoned Estimator::reckoned_at(Stamp stamp) const {
  const auto after =
      std::lower_bound(odometry_.begin(), odometry_.end(), stamp,
                       [](const Reckoned& of, Stamp moment) { return of.sample.stamp < moment; });
  if (after == odometry_.end()) return odometry_.back();
  if (after == odometry_.begin()) return *after;
  const Reckoned& before = *std::prev(after);
  Interval part =
      drive::motion_between(before.sample, after->sample, grid_scale_, description_.timeline.gap_s);
  part.dt_s = seconds_between(before.sample.stamp, stamp);
  const Eigen::Vector3d way = way_of(part, standstill_mps_);
  return {before.sample, before.giver, moved(before.pose, way), before.way_m + std::abs(way[0])};
}

/// Tells whether the receiver repeats a position while the vehicle moves away from it.
bool Estimator::repeats(const Fix& fix) {
  constexpr double kMoves = 5;
  Receiver& receiver = receivers_[fix.source];
  const double way_m = reckoned_at(fix.stamp).way_m;
  if (receiver.still && *receiver.still == fix.position) return way_m - receiver.still_way_m > kMoves;
  receiver.still = fix.position;
  receiver.still_way_m = way_m;
  return false;
}

std::string Estimator::judged_by_gate(const Fix& fix) {
  constexpr std::size_t kKept = 20;
  const std::string& name = description_.gnss[static_cast<std::size_t>(fix.source)].name;
  const drive::GateOptions gate = drive::for_absolute(settings_, name, registry_).gate;
  if (!gate.enabled.value_or(true)) return "";
  Receiver& receiver = receivers_[fix.source];
  Eigen::Vector3d antenna = reckoned_at(fix.stamp).pose;
  antenna.head<2>() += rotate(antenna[2], fix.antenna_m);
  if (!receiver.judged.empty() && fix.stamp <= receiver.judged.back().stamp) return "";  // a late one
  receiver.judged.push_back(fix);
  receiver.reckoned.push_back(antenna);
  if (receiver.judged.size() > kKept) {
    receiver.judged.pop_front();
    receiver.reckoned.pop_front();
  }
  std::vector<Fix> fixes(receiver.judged.begin(), receiver.judged.end());
  for (Fix& one : fixes) one.source = 0;
  const std::vector<Eigen::Vector3d> reckoned(receiver.reckoned.begin(), receiver.reckoned.end());
  (void)drive::apply_gate(fixes, reckoned, gate);
  return fixes.back().status == FixStatus::rejected ? fixes.back().reason : "";
}

std::string Estimator::reason_against(const Fix& fix) {
  if (repeats(fix)) return "frozen";
  if (std::string reason = judged_by_gate(fix); !reason.empty()) return reason;
  return is_absurd(fix) ? "absurd" : "";
}

// Only what cannot be is refused here; the rest is left to the error model.
bool Estimator::is_absurd(const Fix& fix) const {
  if (!window_) return false;
  constexpr double kUnmodelled = 5;  // m: slow errors of a receiver
  const Eigen::Vector2d off = fix.position - window_->antenna_at(fix);
  const Eigen::Matrix2d spread = window_->covariance().topLeftCorner<2, 2>() + 4 * fix.covariance +
                                 kUnmodelled * kUnmodelled * Eigen::Matrix2d::Identity();
  return off.dot(spread.inverse() * off) > live_.absurd;
}

/// Tells whether so many absurd fixes in a row agree with each other that it is the estimate which is wrong.
bool Estimator::convinces(const Fix& fix) {
  if (!absurd_.empty()) {
    const Fix& before = absurd_.back();
    const Reckoned from = reckoned_at(before.stamp);
    const Reckoned to = reckoned_at(fix.stamp);
    const double way_m = (to.pose - from.pose).head<2>().norm();
    const double step_m = (fix.position - before.position).norm();
    const double allowed_m = 10 + 3 * (fix.accuracy_m() + before.accuracy_m());
    if (std::abs(step_m - way_m) > allowed_m || fix.stamp <= before.stamp) absurd_.clear();
  }
  absurd_.push_back(fix);
  return absurd_.size() >= static_cast<std::size_t>(live_.fixes_that_convince);
}

void Estimator::use(const GeodeticFix& geodetic) {
  if (odometry_.empty() || geodetic.stamp < odometry_.front().sample.stamp ||
      (window_ && geodetic.stamp < window_->oldest())) {
    refuse(geodetic, "late", "a fix is older than the window");
    return;
  }
  if (is_thinned(geodetic)) {
    counts_.refused[source_of(geodetic) + ": thinned"] += 1;
    return;
  }
  Fix fix = projected(geodetic);
  fix.epoch = ++epoch_;
  grid_scale_ = fix.grid_scale;
  if (const std::string reason = reason_against(fix); !reason.empty()) {
    const double off_m = window_ ? (fix.position - window_->antenna_at(fix)).norm() : 0;
    refuse(geodetic, reason,
           fmt::format("a fix is not used ({}), {:.1f} m from the estimate", reason, off_m));
    if (reason == "absurd" && convinces(fix)) begin_at_believed();
    return;
  }
  absurd_.clear();
  counts_.taken[source_of(geodetic)] += 1;
  note_place_at(fix.stamp);
  std::vector<Fix>& used = receivers_[fix.source].used;
  used.push_back(fix);
  if (used.size() > 2 * kClaims) used.erase(used.begin(), used.end() - kClaims);
  if (!window_) {
    const auto place = std::upper_bound(fixes_.begin(), fixes_.end(), fix.stamp,
                                        [](Stamp stamp, const Fix& other) { return stamp < other.stamp; });
    fixes_.insert(place, fix);
    publish_place(fix);
    return;
  }
  window_->add_fix(fix, claimed_accuracies(used));
  cycle();
  publish(true);
  drop();
}

void Estimator::begin_at_believed() {
  const std::vector<Fix> believed = std::exchange(absurd_, {});
  reset("reset",
        fmt::format("{} fixes in a row contradict the estimate and agree with each other", believed.size()));
  fixes_.assign(believed.begin(), believed.end());
}

/// Something tells where the vehicle was.
void Estimator::note_place_at(Stamp stamp) {
  if (last_fix_ && stamp < *last_fix_) {
    ++counts_.late_fixes;
    return;
  }
  if (last_fix_) {
    fix_intervals_s_.push_back(seconds_between(*last_fix_, stamp));
    if (fix_intervals_s_.size() > 20) fix_intervals_s_.pop_front();
  }
  last_fix_ = stamp;
}

void Estimator::use(const SensorReading& reading) {
  if (const std::string error = rough_.error_of(reading); !error.empty()) {
    refuse(reading, "impossible", error);
    return;
  }
  counts_.taken[source_of(reading)] += 1;
  rough_.take(reading);
  if (!window_) {
    readings_.push_back(reading);
  } else if (reading.stamp >= window_->oldest()) {
    window_->add_reading(reading.sensor, reading.stamp, reading.values);
  }
}

// Without a receiver, epochs of a sensor place the start. The window has the readings themselves; single
// epochs are far too rough to contradict it.
void Estimator::use_rough_places() {
  if (!rough_.any()) return;
  for (const RoughPosition& position : rough_.before(now_)) {
    if (!frame_ && position.sigma_m > kPlacesFrame_m) continue;
    const Fix place = drive::rough_fix(position, projection_at(drive::geodetic_from_ecef(position.ecef)));
    grid_scale_ = place.grid_scale;
    note_place_at(place.stamp);
    if (!window_) {
      fixes_.push_back(place);
      publish_place(place);
      continue;
    }
    window_->use_readings();
    cycle();
    publish(true);
    drop();
  }
}

/// Finds the minimum. The window moves on even if nothing new tells the place.
void Estimator::cycle() {
  last_cycle_ = now_;
  if (window_->solve()) {
    ++counts_.solutions;
    failures_ = 0;
    return;
  }
  ++counts_.failures;
  say("failure", "", "the window has no minimum; the last one is kept");
  if (++failures_ >= live_.failures_to_reset)
    reset("reset", fmt::format("{} solutions in a row have failed", failures_));
}

void Estimator::drop() {
  // A stretch at a time: after it everything is linearised anew.
  const double stretch_s = std::clamp(live_.window_s / 6, kSecondsWithoutFix, kLongestStretch);
  if (!window_ || seconds_between(window_->oldest(), now_) < live_.window_s + stretch_s) return;
  for (const StampedPose& pose : window_->drop_before(now_.later(-live_.window_s)))
    reports_.emplace_back(SettledPose{pose.stamp, pose.pose, counts_.resets});
}

void Estimator::reset(const std::string& kind, const std::string& text) {
  if (window_) {
    for (const StampedPose& pose : window_->remaining())
      reports_.emplace_back(SettledPose{pose.stamp, pose.pose, counts_.resets});
    ++counts_.resets;
  }
  window_.reset();
  warm_.reset();
  absurd_.clear();
  fixes_.clear();
  readings_.clear();
  failures_ = 0;
  say(kind, "", text);
}

/// The way that the fixes show must be long beside their errors: else it has no direction.
bool Estimator::heading_is_known() const {
  if (fixes_.size() < 2) return false;
  const Reckoned from = reckoned_at(fixes_.front().stamp);
  const Reckoned to = reckoned_at(fixes_.back().stamp);
  const double reckoned_m = (to.pose - from.pose).head<2>().norm();
  const double shown_m = (fixes_.back().position - fixes_.front().position).norm();
  double squares = 0;
  for (const Fix& fix : fixes_) squares += fix.accuracy_m() * fix.accuracy_m();
  const double sigma_m = std::max(2.0, std::sqrt(squares / static_cast<double>(fixes_.size())));
  const double least_m = std::max(live_.least_distance_m, std::sqrt(2.0) * sigma_m / live_.heading_sigma_rad);
  return std::min(reckoned_m, shown_m) >= least_m;
}

PlacedStretch Estimator::stretch() const {
  PlacedStretch stretch;
  drive::Timeline timeline;
  for (const Reckoned& node : odometry_) timeline.stamps.push_back(node.sample.stamp);
  for (std::size_t i = 1; i < odometry_.size(); ++i) {
    timeline.intervals.push_back(drive::motion_between(odometry_[i - 1].sample, odometry_[i].sample,
                                                       grid_scale_, description_.timeline.gap_s));
    stretch.givers.push_back(timeline.intervals.back().bridged ? 0 : odometry_[i].giver);
  }
  const std::vector<Fix> fixes(fixes_.begin(), fixes_.end());
  for (const Fix& fix : fixes) {
    const DriveNodes nodes{timeline.stamps, {}, timeline.intervals};
    timeline.fix_node.push_back(nearest_node(nodes, fix.stamp, 1e9)->node);
  }
  const drive::Start start = drive::make_start(timeline, fixes, standstill_mps_, settings_.initial_guess);
  stretch.stamps = timeline.stamps;
  stretch.intervals = timeline.intervals;
  stretch.poses = start.poses;
  stretch.fixes = measured_fixes();
  return stretch;
}

/// Rough places are a start, and no measurements.
std::vector<Fix> Estimator::measured_fixes() const {
  if (rough_.any()) return {};
  return {fixes_.begin(), fixes_.end()};
}

drive::DriveFacts Estimator::facts() const {
  drive::DriveFacts facts;
  for (const drive::OdometryConfig& odometry : description_.odometry) facts.relative.push_back(odometry.name);
  if (!description_.gnss.empty()) facts.antenna_m = description_.gnss.front().antenna_m;
  facts.gap_noise_factor = description_.timeline.gap_noise_factor;
  drive::PreparedDrive surroundings;
  surroundings.frame = *frame_;
  surroundings.scale = description_.scale();
  facts.surroundings = std::make_shared<const drive::DriveSurroundings>(surroundings, std::vector<Fix>());
  for (std::size_t source = 0; source < description_.gnss.size(); ++source) {
    const std::string name = drive::group_of(settings_, description_.gnss[source].name);
    auto group = std::find_if(facts.absolute.begin(), facts.absolute.end(),
                              [&](const drive::AbsoluteGroup& known) { return known.name == name; });
    if (group == facts.absolute.end())
      group = facts.absolute.insert(facts.absolute.end(), drive::AbsoluteGroup{.name = name, .sources = {}});
    group->sources.push_back(static_cast<int>(source));
  }
  return facts;
}

std::unique_ptr<Window> Estimator::empty_window(std::optional<drive::FirstPose> first_pose) const {
  drive::DriveFacts known = facts();
  known.first_pose = std::move(first_pose);
  std::vector<drive::PreparedSensor> sensors;
  for (const drive::SensorConfig& config : description_.sensors) {
    drive::PreparedSensor sensor{.name = config.name, .options = config.options, .place = config.place};
    sensor.source = config.source.empty() ? config.name : config.source;
    sensor.readings.columns = config.log ? config.log->request.readings.size() : 0;
    sensors.push_back(std::move(sensor));
  }
  return std::make_unique<Window>(std::move(known), std::move(sensors), settings_, registry_);
}

void Estimator::begin_window(const PlacedStretch& stretch, std::optional<drive::FirstPose> first_pose) {
  std::unique_ptr<Window> window = empty_window(std::move(first_pose));
  for (const SensorReading& reading : readings_)
    if (reading.stamp >= stretch.stamps.front())
      window->add_reading(reading.sensor, reading.stamp, reading.values);
  if (!window->begin(stretch)) {
    say("failure", "", "the first fixes and the odometry have no common minimum");
    return;
  }
  if (warm_ && !warm_->states.empty()) {
    window->add_known(warm_->states);
    if (!window->solve()) return;
  }
  warm_.reset();
  window_ = std::move(window);
  fixes_.clear();
  readings_.clear();
  smooth_ = window_->newest_pose();
  last_cycle_ = now_;
  ++counts_.solutions;
  publish(true);
  drop();
}

// A pose of a former run holds if the vehicle has not been moved since: the first fix decides.
void Estimator::align_warm() {
  const Fix& fix = fixes_.front();
  const Eigen::Vector3d pose = *warm_->pose;
  const Eigen::Vector2d antenna = pose.head<2>() + rotate(pose[2], fix.antenna_m);
  const Eigen::Matrix2d spread =
      warm_->covariance.topLeftCorner<2, 2>() + 4 * fix.covariance + 25 * Eigen::Matrix2d::Identity();
  const Eigen::Vector2d off = fix.position - antenna;
  if (off.dot(spread.inverse() * off) > live_.absurd) {
    say("moved", "",
        fmt::format("the vehicle is {:.1f} m from where the former run ended: its pose is not used",
                    off.norm()));
    warm_->pose.reset();
    return;
  }
  PlacedStretch placed;
  for (const Reckoned& node : odometry_) {
    placed.stamps.push_back(node.sample.stamp);
    const Eigen::Vector3d way = between(to_pose(odometry_.front().pose), to_pose(node.pose)).vector();
    placed.poses.push_back(compose(to_pose(pose), to_pose(way)).vector());
  }
  for (std::size_t i = 1; i < odometry_.size(); ++i) {
    placed.intervals.push_back(drive::motion_between(odometry_[i - 1].sample, odometry_[i].sample,
                                                     grid_scale_, description_.timeline.gap_s));
    placed.givers.push_back(placed.intervals.back().bridged ? 0 : odometry_[i].giver);
  }
  placed.fixes = measured_fixes();
  drive::FirstPose first;
  first.position = pose.head<2>();
  first.heading_rad = pose[2];
  first.sigma_m = std::sqrt(0.5 * warm_->covariance.topLeftCorner<2, 2>().trace());
  first.sigma_rad = std::sqrt(warm_->covariance(2, 2));
  begin_window(placed, first);
}

void Estimator::align() {
  if (odometry_.size() < 2 || fixes_.empty()) return;
  if (warm_ && warm_->pose) {
    align_warm();
    if (window_ || (warm_ && warm_->pose)) return;
  }
  if (rough_.any() && seconds_between(fixes_.front().stamp, now_) < kRoughStart_s) return;
  if (heading_is_known()) begin_window(stretch(), std::nullopt);
}

double Estimator::usual_interval_s() const {
  if (fix_intervals_s_.empty()) return kSecondsWithoutFix;
  std::vector<double> intervals(fix_intervals_s_.begin(), fix_intervals_s_.end());
  return upper_median(intervals);
}

double Estimator::radius95_m() const {
  constexpr double kRadius95 = 2.4477468306808161;  // sqrt of the 95 % point of chi-square with 2 freedoms
  const Eigen::Matrix2d place = window_->covariance().topLeftCorner<2, 2>();
  const double half_trace = 0.5 * place.trace();
  const double root = std::sqrt(std::max(0.0, half_trace * half_trace - place.determinant()));
  return kRadius95 * std::sqrt(std::max(0.0, half_trace + root));
}

void Estimator::change_state(State state, const std::string& why) {
  if (state == state_) return;
  say("state", "",
      fmt::format("{} -> {}{}{}", to_string(state_), to_string(state), why.empty() ? "" : ": ", why));
  state_ = state;
}

void Estimator::judge_state() {
  if (!window_) {
    change_state(odometry_.size() < 2 || !last_fix_ ? State::waiting : State::aligning, "");
    return;
  }
  const double age_s = last_fix_ ? seconds_between(*last_fix_, now_) : 0;
  const double radius_m = radius95_m();
  constexpr double kLeaves = 0.8;  // of the limit: else the state changes with every fix
  if (radius_m > live_.lost_radius_m) {
    change_state(State::lost, fmt::format("the radius of 95 % is {:.0f} m", radius_m));
  } else if (radius_m > live_.degraded_radius_m * (state_ == State::degraded ? kLeaves : 1)) {
    change_state(State::degraded, fmt::format("the radius of 95 % is {:.1f} m", radius_m));
  } else if (age_s > std::max(kFixIsOld, 2.5 * usual_interval_s())) {
    change_state(State::dead_reckoning, fmt::format("no fix was used for {:.1f} s", age_s));
  } else {
    change_state(State::tracking, "");
  }
}

void Estimator::publish(bool corrected) {
  judge_state();
  LivePose pose;
  pose.stamp = now_;
  pose.pose = window_->newest_pose();
  pose.covariance = window_->covariance();
  pose.smooth = smooth_;
  pose.speed_mps = odometry_.back().sample.speed_mps;
  pose.yaw_rate_radps = odometry_.back().sample.yaw_rate_radps;
  pose.state = state_;
  pose.heading_known = true;
  pose.corrected = corrected;
  pose.resets = counts_.resets;
  pose.fix_age_s = last_fix_ ? seconds_between(*last_fix_, now_) : 0;
  pose.height_m = window_->newest_height();
  pose.radius95_m = radius95_m();
  reports_.emplace_back(pose);
}

void Estimator::publish_place(const Fix& fix) {
  if (!window_) judge_state();  // with one it is lost, until the odometry is back
  constexpr double kRadius95 = 2.4477468306808161;
  LivePose pose;
  pose.stamp = fix.stamp;
  pose.pose = {fix.position[0], fix.position[1], 0};
  pose.covariance.topLeftCorner<2, 2>() = fix.covariance;
  pose.covariance(2, 2) = std::pow(180 * kDegree, 2) / 3;  // of a heading that may be any
  pose.state = state_;
  pose.resets = counts_.resets;
  pose.radius95_m = kRadius95 * fix.accuracy_m();
  reports_.emplace_back(pose);
}

std::optional<WarmStart> Estimator::warm_start() const {
  if (!window_) return std::nullopt;
  WarmStart start;
  start.stamp = now_;
  start.frame = *frame_;
  start.pose = window_->newest_pose();
  start.covariance = window_->covariance();
  start.states = window_->open_states();
  return start;
}

std::size_t Estimator::window_size() const {
  return window_ ? window_->poses() : 0;
}

}  // namespace waymark::live
