#include <waymark/tools/drive/logs/prepare.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <map>
#include <utility>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/comparison/agreement.hpp>
#include <waymark/tools/drive/comparison/plausibility.hpp>
#include <waymark/tools/drive/coordinates/coordinate_slips.hpp>
#include <waymark/tools/drive/coordinates/frame_choice.hpp>
#include <waymark/tools/drive/coordinates/projection.hpp>
#include <waymark/tools/drive/logs/prepare_steps.hpp>
#include <waymark/tools/drive/logs/streams.hpp>
#include <waymark/tools/drive/mending/carried.hpp>
#include <waymark/tools/drive/mending/creeping.hpp>
#include <waymark/tools/drive/mending/factor_change.hpp>
#include <waymark/tools/drive/mending/fix_motion.hpp>
#include <waymark/tools/drive/mending/frozen.hpp>
#include <waymark/tools/drive/mending/reversing.hpp>
#include <waymark/tools/drive/mending/speed_leaps.hpp>
#include <waymark/tools/drive/mending/standing.hpp>
#include <waymark/tools/drive/sensors/rough_fixes.hpp>
#include <waymark/tools/drive/sensors/sensor_logs.hpp>

namespace waymark::drive {
namespace {

std::vector<InputFile> inputs_of(const DriveLogs& logs) {
  std::vector<InputFile> inputs;
  const auto add = [&inputs](const DriveLogs::Log& log) {
    inputs.insert(inputs.end(), log.inputs.begin(), log.inputs.end());
  };
  for (const std::vector<DriveLogs::Log>& source : logs.odometry)
    for (const DriveLogs::Log& log : source) add(log);
  for (std::size_t i = 0; i < logs.gnss.size(); ++i) {
    add(logs.gnss[i]);
    if (i < logs.velocity.size()) add(logs.velocity[i]);
  }
  for (const DriveLogs::Log& log : logs.truth) add(log);
  for (const DriveLogs::Log& log : logs.sensors) add(log);
  return inputs;
}

std::vector<GeodeticTruth> clean_truth(const std::vector<DriveLogs::Log>& logs, TimeScale scale,
                                       PrepareReport& report) {
  std::vector<GeodeticTruth> truth;
  for (const DriveLogs::Log& log : logs) append_log(log.data.truth, log, scale, truth, report.truth, report);
  clean_stream(
      truth, report.truth, [](const GeodeticTruth& t) { return finite_place(t); },
      [](const GeodeticTruth&, const GeodeticTruth&) { return true; },
      [](const GeodeticTruth& a, const GeodeticTruth& b) {
        return same_place(a, b) && a.heading_rad == b.heading_rad;
      });
  note_cleaning("truth poses", report.truth, report);
  describe_stream(truth, 0, report.truth);
  return truth;
}

void require_overlap(const std::vector<GeodeticTruth>& truth, const std::vector<OdometrySample>& odometry,
                     const DriveDescription& description) {
  const bool apart = !truth.empty() && (truth.back().stamp < odometry.front().stamp ||
                                        truth.front().stamp > odometry.back().stamp);
  if (apart)
    throw InputError(
        fmt::format("{}: the truth does not overlap the odometry: odometry {}, truth {} on the scale "
                    "'{}'; check 'time: {{scale, week, offset}}' of both logs and 'time: {{from, to}}'",
                    description.path, span_text(odometry), span_text(truth), to_string(description.scale())));
}

bool in_outage(const OutagePattern& outage, double after_first_s) {
  return outage.length_s > 0 && std::fmod(after_first_s, outage.every_s) >= outage.every_s - outage.length_s;
}

/// Numbers the epochs and withholds the requested ones. Fixes with one stamp are one epoch. Every receiver
/// counts its own fixes.
void number_epochs(std::vector<Fix>& fixes, const DriveDescription& description, PrepareReport& report) {
  int epoch = -1;
  std::map<int, int> count_of;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    if (i == 0 || fixes[i].stamp != fixes[i - 1].stamp) ++epoch;
    fixes[i].epoch = epoch;
    const GnssConfig& receiver = receiver_of(description, static_cast<std::size_t>(fixes[i].source));
    const int number = ++count_of[fixes[i].source];
    const bool nth = receiver.withhold_every >= 2 && number % receiver.withhold_every == 0;
    const double after_first_s = seconds_between(fixes.front().stamp, fixes[i].stamp);
    if (!nth && !receiver.withheld && !in_outage(description.outage, after_first_s)) continue;
    fixes[i].status = FixStatus::withheld;
    fixes[i].reason = "withheld";
    ++report.fixes_withheld;
  }
}

void note_yaw_rate(const std::string& source, const YawRateAtRest& rest, PrepareReport& report) {
  if (!rest.is_derived()) return;
  const char* reason = rest.stated_derived ? "the yaw rate is one from wheels or steering"
                                           : "the yaw rate never changes while the vehicle stands, so it is "
                                             "taken for one from wheels or steering";
  report.notes.push_back(
      source + reason + ": its readings at rest show no bias, and the default calibration has yaw_per_speed");
}

/// Gives speeds without a sign the one that the fixes show. @param source its name and ": ", or empty
void find_signs(const std::string& source, std::vector<OdometrySample>& samples, PreparedDrive& drive) {
  const std::vector<Reversing> backwards = find_reversing(samples, drive.fixes);
  if (backwards.empty()) return;
  drive.report.warnings.push_back(source + warning_of(backwards, samples));
  drive_backwards(backwards, samples);
}

/// Speeds that are noise become 0. @param source its name and ": ", or empty
void find_stops(const std::string& source, std::vector<OdometrySample>& samples, PreparedDrive& drive) {
  double total_s = 0;
  for (const Standing& time : find_standing(samples, drive.fixes)) {
    total_s += time.duration_s(samples);
    for (OdometrySample& sample : time.of(std::span(samples))) sample.speed_mps = 0;
  }
  if (total_s > 0)
    drive.report.notes.push_back(fmt::format(
        "{}the speed reads noise that adds up to a way for {:.0f} s in all: the vehicle is taken to stand there",
        source, total_s));
}

/// Leaves out the samples of each finding.
template <std::derived_from<SampleRange> Finding>
void leave_out(const std::vector<Finding>& found, std::vector<OdometrySample>& samples) {
  for (std::size_t i = found.size(); i-- > 0;) {
    const auto begin = samples.begin();
    samples.erase(begin + static_cast<std::ptrdiff_t>(found[i].first),
                  begin + static_cast<std::ptrdiff_t>(found[i].last + 1));
  }
}

/// Samples of wheels that stand while the vehicle is carried are left out. @param source its name and ": ", or empty
void leave_out_carried(const std::string& source, std::vector<OdometrySample>& samples,
                       PreparedDrive& drive) {
  const std::vector<Carried> carried = find_carried(samples, drive.fixes);
  for (const Carried& time : carried)
    drive.report.warnings.push_back(source + warning_of(time, samples, samples.front().stamp));
  leave_out(carried, samples);
}

/// @param source its name and ": ", of several
void pass_zone(const std::string& source, std::vector<OdometrySample>& samples, PrepareReport& report) {
  if (const PassedZone passed = pass_dead_zone(samples); passed.edges > 0)
    report.notes.push_back(source + note_of(passed));
}

/// Wrong samples of one of several sources are left out: the others measure the motion.
void leave_out_wrong(PreparedDrive& drive) {
  for (PreparedOdometry& source : drive.relative) {
    const std::string name = source.name + ": ";
    note_yaw_rate(name, source.yaw_rate_at_rest, drive.report);
    const Stamp start = source.samples.front().stamp;
    find_stops(name, source.samples, drive);
    leave_out_carried(name, source.samples, drive);
    const std::vector<SpeedLeap> leaps = find_speed_leaps(source.samples);
    if (!leaps.empty()) drive.report.warnings.push_back(name + warning_of(leaps, source.samples));
    leave_out(leaps, source.samples);
    for (const FrozenOdometry& time :
         find_frozen_odometry(source.samples, drive.fixes, source.yaw_rate_at_rest.stated_derived)) {
      drive.report.warnings.push_back(name + warning_of(time, start));
      std::erase_if(source.samples, [&](const OdometrySample& sample) {
        return sample.stamp >= time.from && sample.stamp <= time.to;
      });
    }
    const std::vector<Creeping> creeping = find_creeping(source.samples, drive.fixes);
    if (!creeping.empty()) drive.report.warnings.push_back(name + warning_of(creeping, source.samples));
    leave_out(creeping, source.samples);
    pass_zone(name, source.samples, drive.report);
    find_signs(name, source.samples, drive);
  }
}

/// Samples of a source that contradicts two others are left out.
void let_odometries_agree(PreparedDrive& drive) {
  std::vector<std::vector<OdometrySample>*> sources;
  for (PreparedOdometry& source : drive.relative) sources.push_back(&source.samples);
  for (const Disagreement& disagreement : leave_out_contradictions(sources)) {
    const PreparedOdometry& source = drive.relative[disagreement.source];
    drive.report.warnings.push_back(warning_of(disagreement, source.name, drive.odometry.front().stamp));
  }
}

/// Leaves out relative sources of which no motion is left.
void drop_silent_sources(PreparedDrive& drive) {
  std::erase_if(drive.relative, [&](const PreparedOdometry& source) {
    if (source.samples.size() >= 2) return false;
    drive.report.warnings.push_back(source.name + ": nothing of it is usable, so it is left out");
    return true;
  });
  if (drive.relative.empty()) throw InputError("no relative source has a usable sample");
  drive.odometry_name = drive.relative.front().name;
  drive.yaw_rate_at_rest = drive.relative.front().yaw_rate_at_rest;
}

void cover_gaps(PreparedDrive& drive) {
  std::size_t added = 0;
  drive.odometry = covered_by_all(drive.relative, added);
  if (added > 0)
    drive.report.notes.push_back(
        fmt::format("{} is silent in places, where {} nodes come from the samples of other sources",
                    drive.odometry_name, added));
}

/// Replaces odometry that is missing, or repeats one reading while the fixes move, by their motion.
void mend_by_fixes(PreparedDrive& drive) {
  const bool bridges = drive.timeline.gap_policy == GapPolicy::bridge;
  const std::size_t filled = bridges ? fill_gaps(drive.odometry, drive.fixes, drive.timeline.gap_s) : 0;
  if (filled > 0)
    drive.report.notes.push_back(
        fmt::format("the motion of the fixes is assumed in {} of these places", filled));
  const std::vector<FrozenOdometry> frozen =
      find_frozen_odometry(drive.odometry, drive.fixes, drive.yaw_rate_at_rest.stated_derived);
  assume_motion_of_fixes(frozen, drive.fixes, drive.odometry);
  for (const FrozenOdometry& time : frozen)
    drive.report.warnings.push_back(warning_of(time, drive.odometry.front().stamp));
}

/// Replaces speeds that no vehicle has, or that the fixes show to be otherwise, and gives speeds their sign.
void mend_speeds(PreparedDrive& drive) {
  const std::vector<FactorChange> factors = find_factor_changes(drive.odometry, drive.fixes);
  for (const FactorChange& change : factors)
    drive.report.warnings.push_back(warning_of(change, drive.odometry));
  take_factors(factors, drive.odometry);
  find_stops("", drive.odometry, drive);
  if (drive.timeline.gap_policy == GapPolicy::bridge) leave_out_carried("", drive.odometry, drive);
  const std::vector<SpeedLeap> leaps = find_speed_leaps(drive.odometry);
  if (!leaps.empty()) drive.report.warnings.push_back(warning_of(leaps, drive.odometry));
  bridge_speed_leaps(leaps, drive.odometry);
  const std::vector<Creeping> creeping = find_creeping(drive.odometry, drive.fixes);
  if (!creeping.empty()) drive.report.warnings.push_back(warning_of(creeping, drive.odometry));
  creep(creeping, drive.odometry);
  pass_zone("", drive.odometry, drive.report);
  find_signs("", drive.odometry, drive);
}

void judge_odometry(PreparedDrive& drive) {
  if (!drive.relative.empty()) {
    leave_out_wrong(drive);
    let_odometries_agree(drive);
    drop_silent_sources(drive);
    cover_gaps(drive);
    if (drive.relative.size() == 1) drive.relative.clear();
  } else {
    note_yaw_rate("", drive.yaw_rate_at_rest, drive.report);
    mend_speeds(drive);
  }
  if (!drive.fixes.empty()) mend_by_fixes(drive);
  if (!drive.relative.empty() && !drive.fixes.empty()) return;  // each one is judged (odometry_check.hpp)
  if (std::string warning = warning_of_accelerations(drive.odometry); !warning.empty())
    drive.report.warnings.push_back(std::move(warning));
}

/// Drops the fixes that no odometry covers any more: parts of it were left out.
void cut_fixes(PreparedDrive& drive) {
  if (drive.fixes.empty()) return;
  const std::size_t before = drive.fixes.size();
  std::erase_if(drive.fixes, [&](const Fix& fix) {
    return fix.stamp < drive.odometry.front().stamp || fix.stamp > drive.odometry.back().stamp;
  });
  drive.report.fixes_outside_odometry += before - drive.fixes.size();
  if (drive.fixes.empty()) throw InputError("no fix lies within the usable odometry");
  const int first = drive.fixes.front().epoch;
  for (Fix& fix : drive.fixes) fix.epoch -= first;
}

Vehicle vehicle_of(const DriveDescription& description) {
  if (description.odometry.empty()) return {};
  const OdometryAssembly& stated = description.odometry.front().assembly;
  return {stated.track_width_m, stated.wheelbase_m, stated.steering_ratio, stated.metres_per_tick};
}

/// Gives an error of the projection the log and the stamp of the place that the zone cannot hold.
template <typename Project>
auto projected(const std::string& file, Stamp stamp, const PreparedDrive& drive, Project project) {
  try {
    return project();
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {:.3f} s after the start: {}", file,
                                 seconds_between(drive.odometry.front().stamp, stamp), error.what()));
  }
}

/// Truth that is far away is told before it may fail to be projected.
std::vector<TruthPose> projected_truth(const std::vector<GeodeticTruth>& truth,
                                       const std::vector<GeodeticFix>& fixes,
                                       const std::optional<Projection>& projection, PrepareReport& report) {
  const std::string far_away = warning_of_distance(fixes, truth);
  if (!far_away.empty()) report.warnings.push_back(far_away);
  std::vector<TruthPose> result;
  try {
    for (const GeodeticTruth& pose : truth) result.push_back(projection->project(pose));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}{}{}", far_away, far_away.empty() ? "the truth: " : "; ", error.what()));
  }
  return result;
}

/// Takes the relative sources: the only one, or all of them.
void take_odometry(std::vector<PreparedOdometry> relative, PreparedDrive& drive) {
  drive.odometry_name = relative.front().name;
  drive.yaw_rate_at_rest = relative.front().yaw_rate_at_rest;
  drive.timeline.gap_s = relative.front().gap_s;
  if (relative.size() == 1) {
    drive.odometry = std::move(relative.front().samples);
    return;
  }
  for (const PreparedOdometry& source : relative)
    drive.timeline.gap_s = std::max(drive.timeline.gap_s, source.gap_s);
  drive.relative = std::move(relative);
  std::size_t added = 0;
  drive.odometry = covered_by_all(drive.relative, added);
}

}  // namespace

PreparedDrive prepare_drive(const DriveLogs& logs, const DriveDescription& description) {
  PreparedDrive drive;
  drive.name = description.name;
  drive.environment = description.environment;
  drive.scale = description.scale();
  drive.truth_reference_m = description.truth_reference_m;
  drive.timeline = description.timeline;
  drive.vehicle = vehicle_of(description);
  drive.inputs = inputs_of(logs);
  take_odometry(prepare_odometry(logs, description, drive.report), drive);
  for (std::size_t i = 0; i < logs.gnss.size(); ++i) {
    const GnssConfig& receiver = receiver_of(description, i);
    drive.receivers.push_back({receiver.name, receiver.antenna_m, receiver.antenna_is_stated,
                               !receiver.delay_place.empty(), receiver.smoothing_s});
  }
  const std::vector<GeodeticFix> fixes = prepare_fixes(logs, description, drive.odometry, drive.report);
  const std::vector<GeodeticTruth> truth = clean_truth(logs.truth, drive.scale, drive.report);
  require_overlap(truth, drive.odometry, description);

  try {
    drive.frame = frame_of(description, logs, fixes);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: the first place of the drive: {}", description.path, error.what()));
  }
  drive.first_pose = first_pose_in(drive.frame, description);
  std::optional<Projection> projection;
  if (drive.frame.zone != 0) projection.emplace(drive.frame);
  if (!projection && !truth.empty())
    throw InputError(description.path +
                     ": the truth is geodetic, but no fix and no epoch of a sensor places the drive on the "
                     "Earth; state 'frame: {utm_zone: ..., origin: [...]}'");
  for (const GeodeticFix& fix : fixes) {
    const std::string& file = logs.gnss.at(static_cast<std::size_t>(fix.source)).file;
    drive.fixes.push_back(projected(file, fix.stamp, drive, [&] { return projection->project(fix); }));
    drive.fixes.back().antenna_m = drive.receivers.at(static_cast<std::size_t>(fix.source)).antenna_m;
  }
  drive.truth = projected_truth(truth, fixes, projection, drive.report);
  number_epochs(drive.fixes, description, drive.report);
  judge_odometry(drive);
  cut_fixes(drive);
  for (std::size_t i = 0; i < logs.sensors.size(); ++i) {
    const SensorConfig& sensor = description.sensors[i];
    PreparedSensor& prepared = drive.sensors.emplace_back(PreparedSensor{
        .name = sensor.name, .options = sensor.options, .place = sensor.place, .source = sensor.source});
    if (sensor.log)
      prepared.readings = at_place_of(sensor.place, sensor.name, [&] {
        return prepare_readings(logs.sensors[i], sensor.log->request, drive.scale, fixes,
                                projection ? &*projection : nullptr, drive.report);
      });
    if (projection) prepared.rough = rough_fixes(logs.sensors[i], drive.scale, *projection);
  }
  drive.report.warnings.insert(drive.report.warnings.end(), logs.warnings.begin(), logs.warnings.end());
  std::vector<std::string>& notes = drive.report.notes;
  notes.insert(notes.end(), logs.notes.begin(), logs.notes.end());
  if (!description.time_scale)
    notes.emplace_back("time scale gps is assumed; state time: {scale: gps | utc | unix}");
  return drive;
}

std::vector<TruthPose> prepare_truth(const DriveLogs::Log& log, TimeScale scale, const Frame& frame) {
  PrepareReport report;
  const Projection projection(frame);
  std::vector<TruthPose> truth;
  for (const GeodeticTruth& pose : clean_truth({log}, scale, report))
    truth.push_back(projection.project(pose));
  return truth;
}

}  // namespace waymark::drive
