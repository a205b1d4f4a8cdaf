#include <waymark/tools/live/estimator/estimator.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include <waymark/core/base/angle.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/nodes/receiver_filter.hpp>
#include <waymark/tools/drive/sensors/rough_fixes.hpp>
#include <waymark/tools/live/estimator/window/window_setup.hpp>
#include <waymark/tools/live/learning/claims_ahead.hpp>
#include <waymark/tools/live/learning/unlearned.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::live {
namespace {

constexpr double kSecondsWithoutFix = 2;  // then a solution moves the window on
constexpr double kLongestStretch = 10;    // s of poses that leave the window together
constexpr double kPlacesFrame_m = 1000;   // a frame is not chosen by a rougher place
constexpr double kLooksBack = 60;         // s, for the alignment
constexpr double kRemembered_s = 1800;    // of the drive, to learn from

std::string words_for(const ClockJump& jump) {
  const double jump_s = seconds_between(jump.from, jump.to);
  if (!jump.to_fixes) return fmt::format("the clock of the odometry has jumped by {:.3f} s", jump_s);
  return fmt::format(
      "the stamps of the odometry and of the fixes are {:.3f} s apart: those of the odometry are moved to the fixes, "
      "by the order of arrival",
      jump_s);
}

}  // namespace

Estimator::Estimator(drive::DriveDescription description, const drive::FusionSettings& settings,
                     const LiveSettings& live, const TypeRegistry& registry)
    : description_(std::move(description)),
      stated_(settings),
      setup_{drive::decided(settings, registry), {}},
      live_(live),
      registry_(registry),
      intake_(live.reorder_s, live.longest_gap_s),
      odometries_(description_.odometry.size(), description_.timeline.gap_s),
      guards_(description_.odometry.size()),
      spot_turns_(description_.odometry.size()),
      rough_(description_, registry),
      reckoning_(description_.timeline.gap_s, 0),
      judge_(description_, setup_.settings, live_, registry),
      so_far_(description_, kRemembered_s) {
  if (description_.odometry.empty()) throw UsageError("live fusion needs an odometry");
  if (description_.gnss.empty() && !rough_.any())
    throw UsageError("live fusion needs a receiver, or a sensor that places the vehicle");
  const double gap_s = description_.timeline.gap_s;
  reckoning_ = Reckoning(gap_s, drive::make_odometry_model(
                                    drive::for_relative(setup_.settings, description_.odometry.front().name),
                                    description_.timeline.gap_noise_factor, registry_)
                                    ->standstill_speed());
  set_up();
}

Estimator::~Estimator() = default;

/// What is known and assumed before the drive has told anything holds from the first pose on.
void Estimator::set_up() {
  drive::FusionSettings& settings = setup_.settings;
  settings = drive::decided(with_open_calibration(stated_, description_, so_far_, registry_), registry_);
  for (const drive::OdometryConfig& odometry : description_.odometry) {
    const drive::YawRateAtRest rest{.stated_derived =
                                        drive::is_from_wheels_or_steering(odometry.assembly.yaw_rate_from)};
    const bool by_default = !stated_.calibration;
    if (has_several_odometries())
      drive::adapt_to_yaw_rate_of(odometry.name, rest, by_default, settings, registry_);
    else
      drive::adapt_to_yaw_rate(rest, by_default, settings, registry_);
  }
  if (*settings.estimates_noise) settings = drive::with_noise(std::move(settings), noise_);
  settings = with_usual_noise(std::move(settings), description_, registry_);
  settings =
      with_claims_ahead(std::move(settings), stated_, description_, {noise_, 0, setup_.claimed}, registry_);
}

void Estimator::know_yaw_rate(std::size_t odometry, std::string_view source) {
  const std::string& name = description_.odometry[odometry].name;
  description_.odometry[odometry].assembly.yaw_rate_from = source;  // what is learned needs it as well
  FusionSetup learned = setup_;
  set_up();
  if (says_.counts.lessons == 0 || !has_several_odometries()) return;
  // What a lesson has decided on the others stays.
  learned.settings.sources[name] = setup_.settings.sources[name];
  setup_ = std::move(learned);
}

void Estimator::begin_with(const WarmStart& start) {
  warm_ = start;
  if (*setup_.settings.estimates_noise) {
    noise_ = start.noise;
    std::erase_if(noise_.parameters,
                  [this](const drive::NoiseParameter& parameter) { return !is_open(parameter); });
    set_up();
  }
  if (start.frame.zone != 0 && !frame_) {
    frame_ = start.frame;
    projection_.emplace(*frame_);
  }
}

/// Tells whether a model of this drive has the parameter: the former run may have had others.
bool Estimator::is_open(const drive::NoiseParameter& parameter) const {
  const drive::FusionSettings& settings = setup_.settings;
  return parameter.owner == settings.modeling || parameter.owner == settings.odometry_model ||
         std::any_of(description_.sensors.begin(), description_.sensors.end(),
                     [&](const drive::SensorConfig& sensor) { return sensor.name == parameter.owner; });
}

std::string Estimator::source_of(const Sample& sample) const {
  if (std::holds_alternative<OdometrySample>(sample)) return description_.odometry.front().name;
  if (const auto* further = std::get_if<FurtherOdometry>(&sample))
    return description_.odometry[further->source].name;
  if (const auto* reading = std::get_if<SensorReading>(&sample)) {
    return description_.sensors[reading->sensor].source_name();
  }
  return description_.gnss[static_cast<std::size_t>(std::get<GeodeticFix>(sample).source)].name;
}

void Estimator::say(const std::string& kind, const std::string& source, const std::string& text) {
  says_.say(now_, kind, source, text);
}

void Estimator::refuse(const Sample& sample, const std::string& reason, const std::string& text) {
  says_.refuse(now_, source_of(sample), reason, text);
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
  const bool silent = !reckoning_.empty() && seconds_between(now_, stamp_of(copy)) > live_.silence_s;
  if (fix != nullptr && std::isfinite(fix->latitude_deg) && std::isfinite(fix->longitude_deg) &&
      (reckoning_.empty() || silent)) {
    if (silent)
      says_.change_state(now_, State::lost, fmt::format("no odometry for {:.1f} s", live_.silence_s));
    Fix place = projected(*fix);
    publish_place(place);
  }
  work();
}

void Estimator::finish() {
  intake_.finish();
  work();
  use_pending();
  learner_.forget();
  if (window_) says_.settle(window_->remaining());
}

void Estimator::work() {
  if (const std::optional<double> step_s = intake_.step())
    say("clock", description_.odometry.front().name,
        fmt::format(
            "its clock has stepped by {:.3f} s, and that of the fixes has not: its stamps are moved back by "
            "that from here on",
            *step_s));
  if (const std::optional<ClockJump> jump = intake_.jump()) {
    reset("jump", words_for(*jump));
    forget_motion();
    // After a pause the drive so far is still one drive. After another step of the clock it is not.
    constexpr double kPause_s = 60;
    const double step_s = seconds_between(jump->from, jump->to);
    if (step_s > kPause_s && !jump->to_fixes) {
      so_far_.pause(jump->to, step_s);
    } else {
      so_far_.clear();
      learner_.forget();
    }
  }
  while (std::optional<Sample> sample = intake_.next()) {
    so_far_.take(*sample);
    if (is_left_out(*sample)) {
      learn(std::max(now_, stamp_of(*sample)));  // the others may be silent for good
      continue;
    }
    if (const auto* odometry = std::get_if<OdometrySample>(&*sample)) {
      hear(0, *odometry);
    } else if (const auto* further = std::get_if<FurtherOdometry>(&*sample)) {
      hear(further->source, {.stamp = further->stamp,
                             .speed_mps = further->speed_mps,
                             .yaw_rate_radps = further->yaw_rate_radps,
                             .turn_variance_per_s = further->turn_variance_per_s});
    } else {
      pending_.push_back(std::move(*sample));
      if (!reckoning_.empty() && stamp_of(pending_.back()) <= now_) use_pending();
    }
    learn(now_);
  }
}

/// Forgets where the vehicle was, and what waits for a place.
void Estimator::forget_motion() {
  reckoning_.clear();
  odometries_.clear();
  guards_.assign(guards_.size(), {});
  spot_turns_.assign(spot_turns_.size(), {});
  receivers_.clear();
  fixes_.clear();
  pending_.clear();
  judge_.clear();
  places_.forget_last();
}

bool Estimator::is_left_out(const Sample& sample) {
  if (left_out_.empty()) return false;
  const std::string source = source_of(sample);
  if (!left_out_.contains(source)) return false;
  says_.counts.refused[source + ": left out"] += 1;
  return true;
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

OdometrySample Estimator::guarded(std::size_t source, const OdometrySample& sample) {
  SpeedGuard& guard = guards_[source];
  const bool known = guard.before_leap().has_value();
  const OdometrySample judged = guard.judged(sample);
  if (judged.assumed && !known)
    refuse(
        FurtherOdometry{sample.stamp, source, 0, 0}, "leap",
        fmt::format("the speed leaps from {:.3g} to {:.3g} m/s: the wheels lock or spin, or the reading is "
                    "wrong; until it leaps back, the speed before is assumed, with the noise of a gap",
                    guard.before_leap()->speed_mps, sample.speed_mps));
  return spot_turns_[source].judged(judged);
}

void Estimator::hear(std::size_t source, const OdometrySample& read) {
  const std::string& name = description_.odometry[source].name;
  says_.counts.taken[name] += 1;
  const OdometrySample sample = guarded(source, read);
  if (!has_several_odometries()) return advance(0, sample);
  if (sample.assumed && odometries_.another_speaks(source, sample.stamp)) return;  // it knows better
  if (!odometries_.take(source, sample)) {
    says_.counts.taken[name] -= 1;
    refuse(FurtherOdometry{sample.stamp, source, 0, 0}, "late",
           "a sample is older than others of its source");
    return;
  }
  const std::optional<Stamp> last = reckoning_.empty() ? std::nullopt : std::optional(now_);
  for (const OdometrySample& node : odometries_.nodes(source, last)) {
    const std::size_t before = reckoning_.empty() ? source : reckoning_.nodes().back().giver;
    if (before != source) say("odometry", name, "the nodes come from here now");
    odometries_.made_node(source, node.stamp);
    advance(source, node);
  }
  if (!window_) return;
  for (const MeasuredWay& way :
       odometries_.ways(window_->stamps(), reckoning_.nodes().back().giver, reckoning_.grid_scale()))
    window_->add_way(way);
}

void Estimator::advance(std::size_t source, const OdometrySample& sample) {
  if (!reckoning_.empty() && seconds_between(now_, sample.stamp) > live_.longest_gap_s) {
    reset("reset", fmt::format("no odometry for {:.1f} s", seconds_between(now_, sample.stamp)));
    reckoning_.clear();
    fixes_.clear();
  }
  if (reckoning_.empty()) {
    reckoning_.begin_with(sample, source);
    now_ = sample.stamp;
  } else {
    add_motion(source, sample);
  }
  // A short window is no reason to look back less for the heading.
  const double kept_s = window_ ? live_.window_s + kLongestStretch : std::max(live_.window_s, kLooksBack);
  reckoning_.keep_last(kept_s);
  use_pending();
  use_rough_places();
  if (!window_) {
    const Stamp begin = reckoning_.begin();
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
  const Reckoning::Node& last = reckoning_.nodes().back();
  Interval whole = reckoning_.motion_to(sample);
  if (last.giver != source && !whole.bridged)
    whole = odometries_.between(source, last.sample.stamp, sample.stamp, reckoning_.grid_scale());
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
  reckoning_.add(sample, source, whole);
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
  place.antenna_m = setup_.settings.lever_arm
                        ? description_.gnss[static_cast<std::size_t>(fix.source)].antenna_m
                        : Eigen::Vector2d(0, 0);
  return place;
}

/// Returns Fix::smoothed_m, if the filter of its receiver is stated.
Eigen::Vector2d Estimator::smoothed_m(const Fix& fix) const {
  const double time_s = description_.gnss[static_cast<std::size_t>(fix.source)].smoothing_s.value_or(0);
  if (!(time_s > 0)) return {0, 0};
  const std::deque<Reckoning::Node>& nodes = reckoning_.nodes();
  const auto node_at = [&](Stamp moment) {
    const auto first =
        std::lower_bound(nodes.begin(), nodes.end(), moment,
                         [](const Reckoning::Node& node, Stamp stamp) { return node.sample.stamp < stamp; });
    return static_cast<std::size_t>(first - nodes.begin());
  };
  drive::ReceiverFilter filter(time_s);
  const std::size_t end = std::min(node_at(fix.stamp) + 1, nodes.size());
  for (std::size_t node = node_at(fix.stamp.later(-drive::ReceiverFilter::kForgotten * time_s)) + 1;
       node < end; ++node)
    filter.advance(reckoning_.motion_to_node(node), reckoning_.standstill_mps());
  return filter.beside_m();
}

void Estimator::use(const GeodeticFix& geodetic) {
  if (reckoning_.empty() || geodetic.stamp < reckoning_.begin() ||
      (window_ && geodetic.stamp < window_->oldest())) {
    refuse(geodetic, "late", "a fix is older than the window");
    return;
  }
  if (judge_.is_thinned(geodetic)) {
    says_.counts.refused[source_of(geodetic) + ": thinned"] += 1;
    return;
  }
  Fix fix = projected(geodetic);
  fix.epoch = ++epoch_;
  reckoning_.set_grid_scale(fix.grid_scale);
  fix.smoothed_m = smoothed_m(fix);
  if (const std::string reason = judge_.reason_against(fix, reckoning_, window_.get()); !reason.empty()) {
    const double off_m = window_ ? (fix.position - window_->antenna_at(fix)).norm() : 0;
    refuse(geodetic, reason,
           fmt::format("a fix is not used ({}), {:.1f} m from the estimate", reason, off_m));
    const bool is_elsewhere = reason == "absurd" || reason == "jump";
    if (is_elsewhere && judge_.convinces(fix, reckoning_)) begin_at_believed(fix.source);
    return;
  }
  const ClaimedAccuracies claimed = judge_.accept(fix);
  says_.counts.taken[source_of(geodetic)] += 1;
  if (!places_.note(fix.stamp)) ++says_.counts.late_fixes;
  if (!window_) {
    const auto place = std::upper_bound(fixes_.begin(), fixes_.end(), fix.stamp,
                                        [](Stamp stamp, const Fix& other) { return stamp < other.stamp; });
    fixes_.insert(place, fix);
    publish_place(fix);
    return;
  }
  window_->add_fix(fix, claimed);
  cycle();
  publish(true);
  drop();
  compare_receivers(fix);
}

void Estimator::compare_receivers(const Fix& fix) {
  if (!window_ || description_.gnss.size() < 2) return;
  const double turn = window_->newest_pose()[2] - reckoning_.nodes().back().pose[2];
  receivers_.take(fix, reckoning_.at(fix.stamp).pose, turn);
  const std::vector<drive::ConstantDifference> news = receivers_.news();
  if (news.empty()) return;
  std::vector<std::string> names;
  for (const drive::GnssConfig& receiver : description_.gnss) names.push_back(receiver.name);
  for (const drive::ConstantDifference& difference : news)
    say("receivers", names[static_cast<std::size_t>(difference.second)],
        drive::warning_of(difference, names, "for minutes") + drive::consequence_of(difference));
}

void Estimator::begin_at_believed(int source) {
  const std::vector<Fix> believed = judge_.take_believed(source);
  reset("reset",
        fmt::format("{} fixes in a row contradict the estimate and agree with each other", believed.size()));
  fixes_.assign(believed.begin(), believed.end());
}

void Estimator::use(const SensorReading& reading) {
  if (const std::string error = rough_.error_of(reading); !error.empty()) {
    refuse(reading, "impossible", error);
    return;
  }
  says_.counts.taken[source_of(reading)] += 1;
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
    reckoning_.set_grid_scale(place.grid_scale);
    if (!places_.note(place.stamp)) ++says_.counts.late_fixes;
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
    ++says_.counts.solutions;
    failures_ = 0;
    return;
  }
  says_.fail(now_, "the window has no minimum; the last one is kept");
  if (++failures_ >= live_.failures_to_reset)
    reset("reset", fmt::format("{} solutions in a row have failed", failures_));
}

void Estimator::drop() {
  // A stretch at a time: after it everything is linearised anew.
  const double stretch_s = std::clamp(live_.window_s / 6, kSecondsWithoutFix, kLongestStretch);
  if (!window_ || seconds_between(window_->oldest(), now_) < live_.window_s + stretch_s) return;
  says_.settle(window_->drop_before(now_.later(-live_.window_s)));
}

void Estimator::reset(const std::string& kind, const std::string& text) {
  if (window_) {
    says_.settle(window_->remaining());
    ++says_.counts.resets;
  }
  says_.forget_settled();
  window_.reset();
  warm_.reset();
  judge_.forget_elsewhere();
  fixes_.clear();
  readings_.clear();
  failures_ = 0;
  say(kind, "", text);
}

void Estimator::judge_state() {
  if (!window_) {
    const bool has_both = reckoning_.nodes().size() >= 2 && places_.any();
    return says_.change_state(now_, has_both ? State::aligning : State::waiting, "");
  }
  const JudgedState judged =
      judge_estimate(says_.state(), radius95_m(covariance().topLeftCorner<2, 2>()), places_, now_, live_);
  says_.change_state(now_, judged.state, judged.why);
}

// Of the newest pose: what the window leaves open of it, and what the drive so far leaves open of the noise.
Eigen::Matrix3d Estimator::covariance() const {
  const Eigen::Matrix3d known_noise = window_->covariance();
  const Eigen::Matrix3d widened = known_noise + spread_;
  return Eigen::LLT<Eigen::Matrix3d>(widened).info() == Eigen::Success ? widened : known_noise;
}

void Estimator::publish(bool corrected) {
  judge_state();
  LivePose pose;
  pose.stamp = now_;
  pose.pose = window_->newest_pose();
  pose.covariance = covariance();
  pose.smooth = smooth_;
  const OdometrySample& newest = reckoning_.nodes().back().sample;
  pose.speed_mps = newest.speed_mps;
  pose.yaw_rate_radps = newest.yaw_rate_radps;
  pose.state = says_.state();
  pose.heading_known = true;
  pose.corrected = corrected;
  pose.resets = says_.counts.resets;
  pose.fix_age_s = places_.age_s(now_);
  pose.height_m = window_->newest_height();
  pose.radius95_m = radius95_m(pose.covariance.topLeftCorner<2, 2>());
  says_.publish(pose);
}

void Estimator::publish_place(const Fix& fix) {
  if (!window_) judge_state();  // with one it is lost, until the odometry is back
  LivePose pose;
  pose.stamp = fix.stamp;
  pose.pose = {fix.position[0], fix.position[1], 0};
  pose.covariance.topLeftCorner<2, 2>() = fix.covariance;
  pose.covariance(2, 2) = std::pow(180 * kDegree, 2) / 3;  // of a heading that may be any
  pose.state = says_.state();
  pose.resets = says_.counts.resets;
  pose.radius95_m = radius95_m(fix.accuracy_m() * fix.accuracy_m() * Eigen::Matrix2d::Identity());
  says_.publish(pose);
}

std::optional<WarmStart> Estimator::warm_start() const {
  if (!window_) return std::nullopt;
  WarmStart start;
  start.stamp = now_;
  start.frame = *frame_;
  start.pose = window_->newest_pose();
  start.covariance = covariance();
  start.states = window_->open_states();
  start.noise = noise_;
  return start;
}

std::size_t Estimator::window_size() const {
  return window_ ? window_->poses() : 0;
}

}  // namespace waymark::live
