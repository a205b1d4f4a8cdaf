#include <waymark/tools/drive/model/fuse.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/tools/drive/estimation/latency.hpp>
#include <waymark/tools/drive/estimation/noise_spread.hpp>
#include <waymark/tools/drive/estimation/scale_priors.hpp>
#include <waymark/tools/drive/model/build.hpp>
#include <waymark/tools/drive/model/provenance.hpp>
#include <waymark/tools/drive/trials/lag_left.hpp>
#include <waymark/tools/drive/trials/receiver_smoothing.hpp>

namespace waymark::drive {
namespace {

double distance_of(const Timeline& timeline) {
  double distance_m = 0;
  for (const Interval& interval : timeline.intervals)
    distance_m += std::abs(interval.speed_mps) * interval.dt_s;
  return distance_m;
}

constexpr const char* kTimeOffset = "time_offset";

/// How far the fixes of a group may be along the way, in units of their accuracy, by what is not known of
/// their delay.
struct LeftUnknown {
  double way_m = 0;
  double of_accuracy = 0;
};

LeftUnknown left_unknown(const TimeOffset& offset, const AbsoluteGroup& group, const PlacedDrive& placed) {
  std::vector<double> accuracies;
  for (const Fix& fix : placed.fixes)
    if (std::find(group.sources.begin(), group.sources.end(), fix.source) != group.sources.end())
      accuracies.push_back(fix.accuracy_m());
  double squared = 0;
  double duration_s = 0;
  for (const Interval& interval : placed.timeline.intervals) {
    squared += interval.speed_mps * interval.speed_mps * interval.dt_s;
    duration_s += interval.dt_s;
  }
  if (accuracies.empty() || !(duration_s > 0)) return {};
  const double way_m = offset.sigma_s * std::sqrt(squared / duration_s);
  return {way_m, way_m / upper_median(std::move(accuracies))};
}

/// Returns what follows the name of a source in a note, if there are several.
std::string of_several(const AbsoluteGroup& group, const ModeledDrive& modeled) {
  return modeled.placed.receivers.size() > 1 ? group.name + ": " : std::string();
}

/// Takes the fixes of a group as measured when their stamps say.
void leave_out(const AbsoluteGroup& group, FusionSettings& settings, ModeledDrive& modeled) {
  if (modeled.placed.receivers.size() > 1 || settings.sources.contains(group.name)) {
    settings.sources[group.name].options[kTimeOffset] = "off";
    modeled.without_delay.push_back(group.name);
  } else {
    settings.modeling_options[kTimeOffset] = "off";
    (*settings.calibration)[kTimeOffset] = "off";
    modeled.without_delay.emplace_back();
  }
  for (const int source : group.sources) modeled.placed.time_offsets_s[static_cast<std::size_t>(source)] = 0;
}

/// Says what the drive knows of a delay that is left out.
std::string note_of(const TimeOffset& offset, const AbsoluteGroup& group, const ModeledDrive& modeled) {
  const LeftUnknown unknown = left_unknown(offset, group, modeled.placed);
  return fmt::format(
      "{}the fixes are taken as not late: the drive says {:.3f} +- {:.3f} s, odds of {:.3g} to 1 for no delay{}",
      of_several(group, modeled), offset.value_s, offset.sigma_s, offset.odds_of_none(),
      unknown.of_accuracy <= 1
          ? std::string()
          : fmt::format(
                "; it hardly tells: if they may be late, '--calibrate on' adds the {:.2g} m along the way "
                "that this leaves open to the covariances",
                unknown.way_m));
}

/// Finds the delay of the fixes, and the noise if it is estimated: each depends on the other.
/// @returns what the drive says about the delay of each group; empty for those that have none
std::vector<std::optional<TimeOffset>> estimate(const FusionSettings& settings,
                                                std::span<const PreparedSensor> sensors,
                                                const TypeRegistry& registry,
                                                const std::function<void()>& between,
                                                TimeOffsetSearch& delays, ModeledDrive& modeled) {
  modeled.settings = settings;
  if (!*settings.estimates_noise) return delays.find(settings, modeled.placed);
  delays.move(settings, modeled.placed);
  modeled.noise = estimate_noise(modeled.placed, sensors, settings, registry, modeled.noise, between);
  modeled.settings = with_noise(settings, modeled.noise);
  return delays.find(modeled.settings, modeled.placed);
}

/// Tells whether the delay of a group may be left out, because nobody stated how it is found.
bool is_delay_open(const AbsoluteGroup& group, const FusionSettings& stated) {
  if (stated.calibration || stated.modeling_options.contains(kTimeOffset)) return false;
  const auto own = stated.sources.find(group.name);
  return own == stated.sources.end() ||
         (!own->second.options.contains(kTimeOffset) && !own->second.calibration.contains(kTimeOffset));
}

/// Leaves out the delays that the drive gives no better odds than their priors, unless they are stated: an offset
/// that is not needed costs RTK fixes at 30 m/s a decimetre.
/// @returns whether there was one
bool leave_out_improbable(const std::vector<std::optional<TimeOffset>>& offsets, const FusionSettings& stated,
                          FusionSettings& decision, ModeledDrive& modeled) {
  const std::vector<AbsoluteGroup> groups = groups_of(modeled.placed, decision);
  bool any = false;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (!is_delay_open(groups[g], stated) || !offsets[g] || offsets[g]->odds_of_none() <= 1) continue;
    leave_out(groups[g], decision, modeled);
    modeled.notes.push_back(note_of(*offsets[g], groups[g], modeled));
    any = true;
  }
  return any;
}

/// Leaves out the delays that nobody stated: an odometry that is worth little moves the fixes along the way as it
/// likes. @returns whether there was one
bool leave_out_unseen(const FusionSettings& stated, FusionSettings& decision, ModeledDrive& modeled) {
  const std::vector<std::string> before = modeled.without_delay;
  bool any = false;
  for (const AbsoluteGroup& group : groups_of(modeled.placed, decision)) {
    const bool is_left_out = std::any_of(before.begin(), before.end(), [&](const std::string& name) {
      return name.empty() || name == group.name;
    });
    if (is_left_out || !is_delay_open(group, stated)) continue;
    leave_out(group, decision, modeled);
    modeled.notes.push_back(
        of_several(group, modeled) +
        "the fixes are taken as not late: an odometry that is worth so little cannot tell");
    any = true;
  }
  return any;
}

/// Returns the sources for the document; empty for one odometry and one receiver alone.
std::vector<formats::DocumentSource> document_sources(const PreparedDrive& drive, const PlacedDrive& placed,
                                                      const SourceShares& shares,
                                                      const FusionSettings& settings) {
  std::vector<formats::DocumentSource> sources;
  if (drive.relative.empty() && drive.receivers.size() < 2 && drive.sensors.empty()) return sources;
  const auto add = [&](const std::string& name, const std::string& kind, const Eigen::Vector2d& antenna_m) {
    // Members of a group have its states; its edges are counted once.
    const auto own = shares.find(group_of(settings, name));
    sources.push_back({name, kind, antenna_m, {}, {}});
    if (own == shares.end()) return;
    sources.back().vertices = own->second.vertices;
    if (own->first == name) sources.back().edges = own->second.edges;
  };
  if (drive.relative.empty()) add(drive.odometry_name, "odometry", {0, 0});
  for (const PreparedOdometry& source : drive.relative) add(source.name, "odometry", {0, 0});
  for (std::size_t i = 0; i < drive.receivers.size(); ++i) {
    const auto fix = std::find_if(placed.fixes.begin(), placed.fixes.end(),
                                  [&](const Fix& of) { return of.source == static_cast<int>(i); });
    add(drive.receivers[i].name, "gnss",
        fix == placed.fixes.end() ? drive.receivers[i].antenna_m : fix->antenna_m);
  }
  for (const PreparedSensor& sensor : drive.sensors) add(sensor.source, sensor.name, {0, 0});
  return sources;
}

/// @throws InputError if the drive was read wrong
void refuse_misreading(const PlacedDrive& placed) {
  if (placed.misreading.empty()) return;
  throw InputError(of_several(placed) + placed.misreading);
}

/// Adapts the settings to the yaw rate of each relative source.
void adapt(const PreparedDrive& drive, bool by_default, FusionSettings& decision,
           const TypeRegistry& registry) {
  if (drive.relative.empty()) adapt_to_yaw_rate(drive.yaw_rate_at_rest, by_default, decision, registry);
  for (const PreparedOdometry& source : drive.relative)
    adapt_to_yaw_rate_of(source.name, source.yaw_rate_at_rest, by_default, decision, registry);
}

/// Tells whether the drive has but one odometry and its receivers, so that their clocks are all that can differ.
bool has_two_clocks(const PreparedDrive& drive) {
  return drive.relative.empty() && drive.sensors.empty();
}

/// Tells whether what is stated of the delay of a receiver is believed.
bool is_delay_believed(int source, const AbsoluteGroup& group, const PreparedDrive& drive,
                       const FusionSettings& stated) {
  const auto at = static_cast<std::size_t>(source);
  const bool is_stated = at < drive.receivers.size() && drive.receivers[at].delay_is_stated;
  return is_stated || !is_delay_open(group, stated);
}

/// Tells whether fixes that seem early may mean a late odometry, whatever a fusion finds.
bool may_be_late(const PreparedDrive& drive, const FusionSettings& stated, const ModeledDrive& modeled) {
  if (!has_two_clocks(drive) || drive.report.tells_late_quantity) return false;
  const std::vector<AbsoluteGroup> groups = groups_of(modeled.placed, modeled.decision);
  return std::any_of(groups.begin(), groups.end(), [&](const AbsoluteGroup& group) {
    return std::any_of(group.sources.begin(), group.sources.end(),
                       [&](int source) { return !is_delay_believed(source, group, drive, stated); });
  });
}

/// Returns by how much the odometry is late, if all receivers that tell know positions before it had them. What is
/// stated of their delays is believed. Asked only where it may_be_late().
double late_odometry(const PreparedDrive& drive, const FusionSettings& stated, const ModeledDrive& modeled) {
  std::set<int> used;
  for (const Fix& fix : modeled.placed.fixes)
    if (fix.status == FixStatus::accepted) used.insert(fix.source);
  double late_s = std::numeric_limits<double>::infinity();
  for (const AbsoluteGroup& group : groups_of(modeled.placed, modeled.decision)) {
    for (const int source : group.sources) {
      const double early_s = -modeled.placed.time_offsets_s[static_cast<std::size_t>(source)];
      if (!used.contains(source) || early_s == 0) continue;  // it tells nothing
      if (is_delay_believed(source, group, drive, stated)) return 0;
      late_s = std::min(late_s, early_s);
    }
  }
  return std::isfinite(late_s) ? std::max(0.0, late_s) : 0;
}

/// Takes back that the clock of the odometry seems wrong: it is known why.
PreparedDrive with_clock_explained(PreparedDrive drive) {
  if (drive.report.told_clock) std::erase(drive.report.warnings, drive.report.told_clock->warning);
  return drive;
}

std::string words_for_late_odometry(double late_s) {
  return fmt::format(
      "the fixes seem to know positions {:.3f} s before the vehicle had them. Receivers have the clock of GNSS and "
      "are never early, so the odometry is probably late: its readings are moved by that; add {:.3f} to the 'time: "
      "{{offset}}' of its logs; if the stamps of the receiver are wrong, state its 'delay'",
      late_s, -late_s);
}

/// Returns the drive with the antenna of its only receiver at another place.
PreparedDrive with_antenna(PreparedDrive drive, const Eigen::Vector2d& place_m) {
  for (Fix& fix : drive.fixes) fix.antenna_m = place_m;
  for (PreparedReceiver& receiver : drive.receivers) receiver.antenna_m = place_m;
  return drive;
}

bool antenna_is_stated(const PreparedDrive& drive) {
  return std::any_of(drive.receivers.begin(), drive.receivers.end(),
                     [](const PreparedReceiver& receiver) { return receiver.antenna_is_stated; });
}

std::string words_for_poor_odometry(const PlacedDrive& placed) {
  return of_several(placed) +
         "the odometry does not move as the fixes do (a gyro that is dead, wheels that slip, a wrong scale): it is "
         "given little weight, and the result follows the fixes";
}

}  // namespace

std::vector<std::string> ModeledDrive::warnings() const {
  std::vector<std::string> all = placed.warnings;
  all.insert(all.end(), sensor_warnings.begin(), sensor_warnings.end());
  return all;
}

const PlacedDrive& Fusion::placed(const FusionSettings& settings) {
  const double standstill_mps = make_odometry_model(for_relative(settings, drive_.odometry_name),
                                                    drive_.timeline.gap_noise_factor, registry_)
                                    ->standstill_speed();
  Key key{settings.gate, {}, settings.initial_guess, settings.lever_arm, standstill_mps};
  for (const auto& [name, source] : settings.sources) key.gates[name] = source.gate;
  for (const auto& [known, placed] : placed_) {
    if (known == key) return placed;
  }
  if (!timeline_) timeline_ = timeline_of(drive_);
  return placed_.emplace_back(key, place_drive(drive_, *timeline_, settings, registry_)).second;
}

FusionSettings Fusion::decision_on(const FusionSettings& settings) const {
  FusionSettings decision = decided(settings, registry_);
  adapt(drive_, !settings.calibration, decision, registry_);
  return decision;
}

ModeledDrive Fusion::estimated_from(PlacedDrive placed, const FusionSettings& settings) {
  ModeledDrive modeled;
  FusionSettings decision = decision_on(settings);
  modeled.placed = std::move(placed);
  const bool by_default = !settings.calibration || *settings.calibration == default_calibration();
  for (std::string& note : adapt_to_scales(modeled.placed, by_default, registry_, decision))
    modeled.notes.push_back(std::move(note));
  if (modeled.placed.start.follows_fixes) (void)leave_out_unseen(settings, decision, modeled);
  TimeOffsetSearch delays(modeled.placed, drive_.sensors, registry_, between_);
  auto offsets = estimate(decision, drive_.sensors, registry_, between_, delays, modeled);
  for (std::optional<TimeOffset>& offset : offsets)
    if (offset && drive_.report.moved_quantity)
      offset->sigma_s = std::hypot(offset->sigma_s, drive_.report.moved_quantity->sigma_s);
  const bool left_out = modeled.noise.is_poor_odometry(modeled.placed.odometry_name)
                            ? leave_out_unseen(settings, decision, modeled)
                            : leave_out_improbable(offsets, settings, decision, modeled);
  if (left_out) (void)estimate(decision, drive_.sensors, registry_, between_, delays, modeled);
  for (const std::optional<TimeOffset>& offset : offsets)
    if (offset && offset->slip.is_probable()) modeled.slip = offset->slip;
  modeled.decision = std::move(decision);
  return modeled;
}

std::optional<ModeledDrive> Fusion::along_fixes(const PlacedDrive& usual, const FusionSettings& settings,
                                                const ModeledDrive& modeled) {
  // Where both are nearly as probable, a result that follows the fixes costs little if the odometry was sound after all;
  // one that follows a poor odometry may be anywhere.
  constexpr double kEven = -2;
  constexpr double kNearly = -20;    // against a sound odometry it is hundreds
  constexpr double kOfAnother = 10;  // less is the same minimum without a delay
  if (usual.fixes.empty() || settings.initial_guess != StartOptions()) return std::nullopt;
  PlacedDrive along = usual;
  along.start = start_along_fixes(along.timeline, along.fixes, along.standstill_mps);
  if (!may_be_poor_odometry(along, drive_.sensors, modeled.decision, registry_, modeled.noise))
    return std::nullopt;
  ModeledDrive other = estimated_from(std::move(along), settings);
  const double gain = modeled.noise.cost - other.noise.cost;
  const bool is_poor = other.noise.is_poor_odometry(usual.odometry_name);
  // Few fixes of a dead odometry fit receivers that are tens of metres wrong as well; those are rarer.
  const bool spares_fixes = is_poor && modeled.noise.fixes_are_poor() && !other.noise.fixes_are_poor();
  const double least = spares_fixes ? kNearly : is_poor ? kEven : kOfAnother;
  if (!(gain > least)) return std::nullopt;
  return other;
}

ModeledDrive Fusion::searched(const FusionSettings& settings) {
  const PlacedDrive& usual = placed(decision_on(settings));
  ModeledDrive modeled = estimated_from(usual, settings);
  if (modeled.noise.parameters.empty()) return modeled;
  if (std::optional<ModeledDrive> other = along_fixes(usual, settings, modeled)) modeled = std::move(*other);
  if (modeled.noise.is_poor_odometry(modeled.placed.odometry_name))
    modeled.placed.warnings.push_back(words_for_poor_odometry(modeled.placed));
  return modeled;
}

void Fusion::take(PreparedDrive other, const FusionSettings& settings, Freed& freed) const {
  freed.modeled = Fusion(other, registry_, between_).searched(settings);
  freed.drive = std::make_shared<const PreparedDrive>(std::move(other));
}

bool Fusion::take_if_better(PreparedDrive other, double gain, const FusionSettings& settings,
                            Freed& freed) const {
  Freed trial;
  take(std::move(other), settings, trial);
  if (!(freed.modeled.noise.cost - trial.modeled.noise.cost > gain)) return false;
  freed.modeled = std::move(trial.modeled);
  freed.drive = std::move(trial.drive);
  return true;
}

void Fusion::free_of_drift(const FusionSettings& settings, Freed& freed) const {
  constexpr double kGain = 2;  // little, because clocks do drift
  constexpr int kMostRounds = 3;
  const NoiseEstimate& noise = freed.modeled.noise;
  if (!has_two_clocks(drive_) || noise.parameters.empty() || freed.modeled.decision.calibration->empty())
    return;
  if (noise.is_poor_odometry(freed.modeled.placed.odometry_name)) return;
  const Readings drifting = freed.drive;
  ClockDrift drift;
  for (int round = 0; round < kMostRounds; ++round) {
    const std::optional<ClockDrift> left =
        find_clock_drift(freed.modeled.placed, drive_.sensors, freed.modeled.settings, registry_, between_);
    if (left && round > 0) drift.sigma = left->sigma;  // with the noise that is left
    if (!left || !left->is_probable) break;
    const ClockDrift together{drift.rate + left->rate, left->sigma};
    if (!take_if_better(without_drift(drifting ? *drifting : drive_, together), kGain, settings, freed))
      break;
    drift = together;
  }
  freed.modeled.clock_drift = drift;
  if (drift.rate != 0)
    freed.told.push_back(
        warning_of(drift, seconds_between(drive_.fixes.front().stamp, drive_.fixes.back().stamp)));
}

void Fusion::add_deviations(ModeledDrive& modeled) const {
  if (modeled.noise.parameters.empty()) return;
  find_deviations(modeled.placed, drive_.sensors, modeled.decision, registry_, modeled.noise, between_);
}

ModeledDrive Fusion::estimated(const FusionSettings& settings) {
  ModeledDrive modeled = searched(settings);
  add_deviations(modeled);
  return modeled;
}

void Fusion::settle_moved_quantity(const FusionSettings& settings, Freed& freed) const {
  constexpr int kMostRounds = 3;
  if (!drive_.report.moved_quantity) return;
  for (int round = 0; round < kMostRounds; ++round) {
    const PreparedDrive& drive = freed.drive_or(drive_);
    const std::optional<LagLeft> left =
        find_lag_left(drive.report.moved_quantity->kind, freed.modeled.placed, drive.sensors,
                      freed.modeled.settings, registry_, between_);
    if (!left || !left->is_probable()) break;
    take(without_lag_left(drive, *left), settings, freed);
  }
  if (freed.drive) freed.told.push_back(warning_of(*freed.drive->report.moved_quantity));
}

void Fusion::free_of_smoothing(const FusionSettings& settings, Freed& freed) const {
  constexpr double kGain = 15;
  constexpr double kSame_s = 0.02;
  constexpr int kMostRounds = 4;
  if (drive_.receivers.size() != 1 || drive_.receivers.front().smoothing_s) return;
  std::optional<ReceiverSmoothing> found;
  for (int round = 0; round < kMostRounds; ++round) {
    const auto now =
        find_smoothing(freed.modeled.placed, drive_.sensors, freed.modeled.settings, registry_, between_);
    if (!now) break;
    PreparedDrive smoothed = with_clock_explained(freed.drive_or(drive_));
    smoothed.receivers.front().smoothing_s = now->time_s;
    if (!take_if_better(std::move(smoothed), round == 0 ? kGain : 0, settings, freed)) break;
    const bool is_same = found && std::abs(found->time_s - now->time_s) < std::max(kSame_s, now->sigma_s);
    found = now;
    if (is_same || freed.modeled.noise.is_poor_odometry(freed.modeled.placed.odometry_name)) break;
  }
  if (found) freed.told.push_back(warning_of(*found, receiver_name(freed.modeled.placed, 0)));
}

void Fusion::free_of_slip(const FusionSettings& settings, Freed& freed) const {
  constexpr double kGain = 1;     // the slip is three of its own deviations
  constexpr int kMostRounds = 8;  // what the noise hid is found in steps
  const Readings slipping = freed.drive;
  SpeedSlip slip;
  for (int round = 0; round < kMostRounds && freed.modeled.slip.is_probable(); ++round) {
    const SpeedSlip together{slip.per_mps2 + freed.modeled.slip.per_mps2, freed.modeled.slip.sigma};
    if (!take_if_better(without_slip(slipping ? *slipping : drive_, together), kGain, settings, freed)) break;
    slip = together;
  }
  if (slip.per_mps2 != 0) freed.told.push_back(warning_of(slip));
}

void Fusion::put_on_time(const FusionSettings& settings, const std::optional<AntennaPlace>& antenna,
                         Freed& freed) const {
  constexpr double kTold_s = 0.02;
  constexpr double kAsTold = 0.5;
  constexpr int kMostRounds = 3;
  if (!may_be_late(drive_, settings, freed.modeled)) return;
  const ClockDrift drift = freed.modeled.clock_drift;
  double moved_s = 0;
  for (int round = 0; round < kMostRounds; ++round) {
    Freed judged;
    if (antenna) take(with_antenna(freed.drive_or(drive_), antenna->place_m), settings, judged);
    const double late_s = late_odometry(drive_, settings, antenna ? judged.modeled : freed.modeled);
    if (antenna ? late_s < kTold_s : late_s == 0) break;
    PreparedDrive on_time = with_stamps_later(freed.drive_or(drive_), [&](Stamp) { return -late_s; });
    const std::optional<ToldClock>& told = drive_.report.told_clock;
    if (told && told->late_s > 0 && late_s >= kAsTold * told->late_s)
      on_time = with_clock_explained(std::move(on_time));
    take(std::move(on_time), settings, freed);
    moved_s += late_s;
  }
  freed.modeled.clock_drift = drift;
  if (moved_s >= kTold_s)
    freed.told.push_back(words_for_late_odometry(moved_s));
  else if (moved_s > 0)
    freed.modeled.notes.push_back(fmt::format(
        "the odometry is taken to be {:.3f} s late, because the fixes know positions so much earlier",
        moved_s));
}

std::optional<AntennaPlace> Fusion::antenna_beside_slip(const FusionSettings& settings, const Freed& slipping,
                                                        Freed& freed) const {
  const auto found_in = [&](const Freed& of) {
    return Fusion(of.drive_or(drive_), registry_, between_).antenna_of(of.modeled, settings);
  };
  const auto cost_with = [&](const Freed& of, const AntennaPlace& antenna) {
    Freed there;
    take(with_antenna(of.drive_or(drive_), antenna.place_m), settings, there);
    return there.modeled.noise.cost;
  };
  const std::optional<AntennaPlace> antenna = found_in(freed);
  if (freed.drive == slipping.drive) return antenna;
  const std::optional<AntennaPlace> without = found_in(slipping);
  if (!without) return antenna;
  const double cost = antenna ? cost_with(freed, *antenna) : freed.modeled.noise.cost;
  if (cost_with(slipping, *without) > cost) return antenna;
  freed = slipping;
  return without;
}

ModeledDrive Fusion::model(const FusionSettings& settings) {
  refuse_misreading(placed(decision_on(settings)));
  Freed freed{searched(settings)};
  Freed slipping;
  if (drive_.relative.empty() && !freed.modeled.noise.parameters.empty()) {
    settle_moved_quantity(settings, freed);
    free_of_smoothing(settings, freed);
    slipping.drive = freed.drive;
    if (freed.modeled.slip.is_probable()) slipping = freed;
    free_of_slip(settings, freed);
  }
  // An antenna that is elsewhere looks like a clock that is wrong.
  const std::optional<AntennaPlace> antenna = antenna_beside_slip(settings, slipping, freed);
  if (antenna)
    freed.told.push_back(warning_of(*antenna, receiver_name(freed.modeled.placed, 0)));
  else
    free_of_drift(settings, freed);
  put_on_time(settings, antenna, freed);
  return completed(std::move(freed));
}

std::optional<AntennaPlace> Fusion::antenna_of(const ModeledDrive& modeled, const FusionSettings& settings) {
  // Rear wheels that slip sideways in bends move the point of the odometry.
  constexpr double kStatedWithin_m = 0.5;
  constexpr double kStatedShare = 1.0 / 3;
  if (drive_.report.tells_late_quantity || modeled.noise.parameters.empty()) return std::nullopt;
  const bool is_stated = antenna_is_stated(drive_);
  const bool is_poor = modeled.noise.is_poor_odometry(modeled.placed.odometry_name);
  // One that is stated at the point of the odometry is meant to be taken so.
  if (is_stated ? drive_.receivers.front().antenna_m == Eigen::Vector2d::Zero() : is_poor)
    return std::nullopt;
  // One that is stated on the wrong side makes a sound odometry look poor.
  const FusionSettings with = is_poor ? decision_on(settings) : modeled.settings;
  const PlacedDrive& at = is_poor ? placed(with) : modeled.placed;
  const auto found = find_antenna_place(at, drive_.sensors, with, registry_, between_);
  if (!found || !is_stated) return found;
  const double least_m = std::max(kStatedWithin_m, kStatedShare * found->taken_m.norm());
  return (found->place_m - found->taken_m).norm() > least_m ? found : std::nullopt;
}

ModeledDrive Fusion::completed(Freed freed) const {
  ModeledDrive modeled = std::move(freed.modeled);
  std::vector<std::string>& warnings = modeled.placed.warnings;
  warnings.insert(warnings.end(), freed.told.begin(), freed.told.end());
  modeled.other_readings = freed.drive;
  const PreparedDrive& drive = freed.drive_or(drive_);
  add_deviations(modeled);
  BuiltGraph built = build_graph(modeled.placed, drive.sensors, modeled.settings, registry_);
  modeled.sensor_warnings = std::move(built.warnings);
  modeled.modelings = std::move(built.modelings);
  modeled.groups = std::move(built.groups);
  modeled.distance_m = distance_of(modeled.placed.timeline);
  formats::GraphDocument& document = modeled.document;
  document.graph = std::move(built.graph);
  document.frame = drive.frame;
  document.time_scale = drive.scale;
  document.sources = document_sources(drive, modeled.placed, built.shares, modeled.settings);
  if (document.sources.empty() && !modeled.placed.fixes.empty())
    document.antenna_m = modeled.placed.fixes.front().antenna_m;
  document.truth_reference_m = drive.truth_reference_m;
  take_smoothing(modeled.placed);
  document.fixes = modeled.placed.fixes;
  document.provenance = provenance_of(drive, modeled, registry_);
  return modeled;
}

void add_covariances(ModeledDrive& modeled, const std::string& which) {
  add_covariances(modeled.document, which);
  widen(modeled.document.covariances, modeled.document.graph, modeled.noise.spread);
}

FusedDrive minimized(ModeledDrive model, const TypeRegistry& registry, const MinimizationWatch& watch) {
  FusedDrive fused{std::move(model), {}};
  const Minimization& how = fused.model.settings.minimization;
  fused.minimum = minimize(fused.model.document.graph, how, registry, watch);
  if (fused.minimum.summary.converged()) add_covariances(fused.model, how.covariances);
  return fused;
}

FusedDrive Fusion::fuse(const FusionSettings& settings, const MinimizationWatch& watch) {
  return minimized(model(settings), registry_, watch);
}

FusedDrive fuse(const PreparedDrive& drive, const FusionSettings& settings, const TypeRegistry& registry,
                const MinimizationWatch& watch) {
  return Fusion(drive, registry).fuse(settings, watch);
}

}  // namespace waymark::drive
