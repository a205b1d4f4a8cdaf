/// What a drive is freed of, one thing after another: the same drive is fused without it, and what is more probable is
/// kept.
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>

#include <waymark/tools/drive/model/delays.hpp>
#include <waymark/tools/drive/model/fuse.hpp>
#include <waymark/tools/drive/trials/common_errors.hpp>
#include <waymark/tools/drive/trials/lag_left.hpp>
#include <waymark/tools/drive/trials/lasting_jump.hpp>
#include <waymark/tools/drive/trials/receiver_smoothing.hpp>

namespace waymark::drive {
namespace {

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

}  // namespace

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

void Fusion::settle_moved_quantity(const FusionSettings& settings, Freed& freed) const {
  constexpr int kMostRounds = 3;
  if (!drive_.report.moved_quantity) return;
  const Readings before = freed.drive;
  for (int round = 0; round < kMostRounds; ++round) {
    const PreparedDrive& drive = freed.drive_or(drive_);
    const std::optional<LagLeft> left =
        find_lag_left(drive.report.moved_quantity->kind, freed.modeled.placed, drive.sensors,
                      freed.modeled.settings, registry_, between_);
    if (!left || !left->is_probable()) break;
    take(without_lag_left(drive, *left), settings, freed);
  }
  if (freed.drive != before) freed.told.push_back(warning_of(*freed.drive->report.moved_quantity));
}

FusionSettings Fusion::with_common_errors(const FusionSettings& stated, Freed& freed) {
  constexpr double kGain = 5;
  if (freed.modeled.noise.parameters.empty()) return stated;
  const auto common = find_common_errors(freed.modeled.placed, drive_.sensors, stated, freed.modeled.settings,
                                         registry_, between_);
  if (common.empty()) return stated;
  FusionSettings grouped = stated;
  for (const auto& [name, first] : common) grouped.sources[name].common = first;
  ModeledDrive other = searched(grouped);
  if (!(freed.modeled.noise.cost - other.noise.cost > kGain)) return stated;
  freed.modeled = std::move(other);
  freed.told.push_back(warning_of(common));
  return grouped;
}

void Fusion::part_at_jumps(const FusionSettings& settings, Freed& freed) const {
  constexpr double kGain = 5;
  constexpr std::size_t kMost = 5;
  if (freed.modeled.noise.parameters.empty()) return;
  std::vector<LastingJump> jumps;
  while (jumps.size() < kMost) {
    const std::optional<LastingJump> jump = find_lasting_jump(freed.modeled.placed, jumps, drive_.sensors,
                                                              freed.modeled.settings, registry_, between_);
    if (!jump) break;
    jumps.push_back(*jump);
    PreparedDrive parted = freed.drive_or(drive_);
    take_jumps(jumps, parted.fixes);
    if (take_if_better(std::move(parted), kGain, settings, freed)) continue;
    jumps.pop_back();
    break;
  }
  for (const LastingJump& jump : jumps)
    freed.told.push_back(
        warning_of(jump, receiver_name(freed.modeled.placed, jump.source), drive_.fixes.front().stamp));
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

}  // namespace waymark::drive
