#include <waymark/tools/drive/clocks/clock_check.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/stamps/clock_steps.hpp>
#include <waymark/tools/drive/clocks/clock_sync.hpp>
#include <waymark/tools/drive/clocks/late_quantity.hpp>
#include <waymark/tools/drive/clocks/odometry_check.hpp>
#include <waymark/tools/drive/clocks/offset_names.hpp>
#include <waymark/tools/drive/clocks/synchronise.hpp>
#include <waymark/tools/drive/comparison/misreading.hpp>
#include <waymark/tools/drive/coordinates/projection.hpp>
#include <waymark/tools/drive/logs/prepare_steps.hpp>
#include <waymark/tools/drive/logs/streams.hpp>

namespace waymark::drive {
namespace {

/// Fixes may be late by less than this; more are two clocks.
constexpr double kOneClock_s = 2;

std::string statement(const ClockOffset& offset) {
  return fmt::format("state 'time: {{offset: {:.2f}}}' for the logs of 'odometry'", -offset.late_s);
}

std::string remedy(const ClockOffset& offset) {
  return "--sync applies it; or " + statement(offset);
}

/// Returns the offset at which all that is logged fits best. Empty: it fits nowhere.
std::optional<ClockOffset> logged_offset(const LoggedMotion& motion) {
  return estimate_clock_offsets(motion.odometry(), motion.fixes, {}).common();
}

/// Returns why no fixes, or few, lie within the odometry.
std::string explanation(const LoggedMotion& motion, const std::optional<ClockOffset>& offset) {
  if (offset)
    return fmt::format("the motion of both fits if the odometry's clock is {:.2f} s {}{}: {}",
                       std::abs(offset->late_s), offset->late_s < 0 ? "early" : "late",
                       offset_in_words(*offset), remedy(*offset));
  const double apart = seconds_between(motion.fixes.front().stamp, motion.odometry().front().stamp);
  const std::string name = name_of_offset(apart, 600);
  if (!name.empty()) return fmt::format("they begin {:.0f} s apart, which is near {}", apart, name);
  return "their motion fits at no other offset; check 'time: {scale, week, offset}' of both logs and 'time: "
         "{from, to}'";
}

bool lies_within(const Fix& fix, const std::vector<OdometrySample>& odometry) {
  return fix.stamp >= odometry.front().stamp && fix.stamp <= odometry.back().stamp;
}

std::size_t count_within(const LoggedMotion& motion) {
  return static_cast<std::size_t>(
      std::count_if(motion.fixes.begin(), motion.fixes.end(),
                    [&](const Fix& fix) { return lies_within(fix, motion.odometry()); }));
}

[[noreturn]] void refuse(const LoggedMotion& motion, const std::optional<ClockOffset>& offset,
                         const DriveDescription& description) {
  throw InputError(
      fmt::format("{}: {} of {} fixes lie outside the odometry: odometry {}, fixes {} on the "
                  "scale '{}'; {}",
                  description.path, motion.fixes.size() - count_within(motion), motion.fixes.size(),
                  span_text(motion.odometry()), span_text(motion.fixes), to_string(description.scale()),
                  explanation(motion, offset)));
}

/// Returns all that is logged: a stated stretch of the drive says nothing of clocks. Empty if the rest of the logs
/// cannot be used.
std::optional<LoggedMotion> whole_motion(const DriveLogs& logs, DriveDescription description) {
  description.from_s.reset();
  description.to_s.reset();
  try {
    return logged_motion(logs, description);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

/// @throws InputError if no fix lies within the odometry
void refuse_without_overlap(const DriveLogs& logs, const DriveDescription& description) {
  const std::optional<LoggedMotion> motion = whole_motion(logs, description);
  if (motion && !motion->fixes.empty() && count_within(*motion) == 0)
    refuse(*motion, logged_offset(*motion), description);
}

/// @throws InputError if most fixes lie outside the odometry, and the motion of both fits elsewhere
void refuse_wrong_clock(const DriveLogs& logs, const DriveDescription& description) {
  const std::optional<LoggedMotion> motion = whole_motion(logs, description);
  if (!motion || 2 * count_within(*motion) >= motion->fixes.size()) return;
  const std::optional<ClockOffset> offset = logged_offset(*motion);
  if (offset && std::abs(offset->late_s) > kOneClock_s) refuse(*motion, offset, description);
}

/// Prepares a drive of several odometries again, without those that the fixes contradict.
PreparedDrive without_contradicted(PreparedDrive drive, const DriveLogs& logs,
                                   const DriveDescription& description,
                                   const std::set<std::string>& suspects) {
  const OdometryCheck check = check_odometries(drive, suspects);
  if (!check.left_out.empty()) {
    DriveLogs fewer = logs;
    DriveDescription rest = description;
    for (std::size_t i = rest.odometry.size(); i-- > 0;) {
      if (!check.left_out.contains(rest.odometry[i].name)) continue;
      rest.odometry.erase(rest.odometry.begin() + static_cast<std::ptrdiff_t>(i));
      fewer.odometry.erase(fewer.odometry.begin() + static_cast<std::ptrdiff_t>(i));
    }
    drive = prepare_drive(fewer, rest);
    drive.report.left_out = check.left_out;
  }
  std::vector<std::string>& warnings = drive.report.warnings;
  warnings.insert(warnings.end(), check.warnings.begin(), check.warnings.end());
  return drive;
}

/// Whether a second clock is the only reason that is left: a drive that was read wrong fits elsewhere by chance.
bool is_another_clock(const PreparedDrive& drive, const ClockOffset& offset) {
  if (std::abs(offset.late_s) <= kOneClock_s) return false;
  return !find_misreading(build_timeline(drive.odometry, drive.fixes, drive.timeline), drive.fixes,
                          kStands_mps, {});
}

/// Returns what to state if an odometry seems late or early, for each reason that the drive cannot exclude.
/// @param delay_s what is stated of the receiver
std::string remedies(const ClockOffset& offset, bool may_be_speed_alone, double delay_s) {
  if (offset.late_s < 0 && offset.late_s > -kOneClock_s)
    return fmt::format(
        "state 'delay: {:.2f}' for the receiver if its fixes come late (the usual latency); if the odometry's "
        "clock is wrong, {}",
        delay_s - offset.late_s, remedy(offset));
  if (!may_be_speed_alone) return remedy(offset);
  return fmt::format(
      "{}; or 'speed_delay: {:.2f}' if its speed alone is late (OBD, CAN): the turns do not tell which",
      remedy(offset), offset.late_s);
}

/// What was found about the only odometry. It is told once nothing is moved any more: a drive that is prepared again
/// has a report of its own.
struct Found {
  std::vector<std::string> warnings;
  std::optional<ToldClock> told_clock{};  ///< as PrepareReport has them
  bool tells_late_quantity = false;
  std::optional<MovedQuantity> moved_quantity{};
};

/// Moves the stamps of the only odometry to another clock, or tells it.
void treat_clock(const ClockOffset& offset, const DriveLogs& logs, DriveDescription& description,
                 ClocksApart treatment, PreparedDrive& drive, Found& found) {
  std::string cure;
  const bool moves = treatment == ClocksApart::move && is_another_clock(drive, offset);
  if (moves) {
    OdometryConfig& odometry = config_of(drive.odometry_name, description);
    odometry.speed_delay_s += offset.late_s;
    odometry.yaw_rate_delay_s += offset.late_s;
    drive = prepare_drive(logs, description);
    cure = "its stamps are moved by that; " + statement(offset);
  } else {
    const bool may_be_speed_alone =
        offset.late_s >= 0 && offset.late_s <= kOneClock_s && !yaw_rate_is_late(drive.odometry, drive.fixes);
    found.tells_late_quantity |= may_be_speed_alone;
    cure =
        remedies(offset, may_be_speed_alone, description.gnss.empty() ? 0 : description.gnss.front().delay_s);
  }
  found.warnings.push_back(clock_warning("the odometry", offset, cure));
  if (!moves) found.told_clock = {found.warnings.back(), offset.late_s};
}

/// Moves the readings of a quantity that is late alone, until it no longer is: what a late speed seems to contradict was
/// mended by the fixes. @returns how late it was in all
LateQuantity move_late_quantity(LateQuantity late, const DriveLogs& logs, DriveDescription& description,
                                PreparedDrive& drive) {
  constexpr int kMostMoves = 3;
  double& delay_s = late.delay_in(config_of(drive.odometry_name, description));
  delay_s = late.late_s;
  drive = prepare_drive(logs, description);
  for (int moves = 1; moves < kMostMoves; ++moves) {
    const auto left = late_quantity_shown(drive.odometry, drive.fixes, drive.yaw_rate_at_rest);
    if (!left || left->kind != late.kind) break;
    late.late_s += left->late_s;
    delay_s = late.late_s;
    drive = prepare_drive(logs, description);
  }
  return late;
}

/// Treats a quantity that is late alone. What is stated of delays is left as it is: who states them may know more than
/// the fixes do. @returns the odometry without it
std::vector<OdometrySample> without_late_quantity(const LateQuantity& late, const DriveLogs& logs,
                                                  DriveDescription& description, ClocksApart treatment,
                                                  PreparedDrive& drive, Found& found) {
  constexpr double kEven_s = 0.02;  // readings that are held are not late evenly
  const bool moves =
      treatment == ClocksApart::move && !states_delays(config_of(drive.odometry_name, description));
  if (moves) {
    const LateQuantity moved = move_late_quantity(late, logs, description, drive);
    found.moved_quantity = {moved.kind, moved.late_s, std::hypot(moved.sigma_s, kEven_s)};
    found.warnings.push_back(
        late_quantity_warning("the odometry", moved,
                              fmt::format("its readings are moved by that; state '{}: {:.2f}' for 'odometry'",
                                          moved.key(), moved.late_s)));
    return drive.odometry;
  }
  found.tells_late_quantity = true;
  found.warnings.push_back(late_quantity_warning("the odometry", late, late.increase()));
  return without_lateness(drive.odometry, late);
}

/// Takes back the steps of a clock that was set during the drive.
void take_back_steps(const DriveLogs& logs, DriveDescription& description, PreparedDrive& drive,
                     Found& found) {
  if (drive.report.stamp_steps.empty()) return;
  const LoggedMotion motion = logged_motion(logs, description);
  OdometryConfig& odometry = config_of(drive.odometry_name, description);
  odometry.clock_steps = find_clock_steps(drive.report.stamp_steps, motion.odometry(), motion.fixes);
  if (odometry.clock_steps.empty()) return;
  drive = prepare_drive(logs, description);
  for (const StampStep& step : odometry.clock_steps)
    found.warnings.push_back(
        warning_of(step, logs.odometry.front().front().file, motion.odometry().front().stamp));
}

/// Compares speed and yaw rate of the only odometry with the fixes, and what is left with their clock. A quantity that
/// is late alone looks like a clock that is wrong.
PreparedDrive with_clock_told(PreparedDrive drive, const DriveLogs& logs, DriveDescription description,
                              ClocksApart treatment) {
  Found found;
  if (treatment == ClocksApart::move) take_back_steps(logs, description, drive, found);
  std::optional<ClockOffset> offset = offset_shown(drive.odometry, drive.fixes);
  const bool is_far = offset && std::abs(offset->late_s) > kOneClock_s;
  // Fixes that are filtered move and turn late, and are not.
  const auto smooths = [](const PreparedReceiver& receiver) { return receiver.smoothing_s.value_or(0) > 0; };
  const bool is_filtered = !is_far && std::any_of(drive.receivers.begin(), drive.receivers.end(), smooths);
  const auto late = is_far || is_filtered
                        ? std::nullopt
                        : late_quantity_shown(drive.odometry, drive.fixes, drive.yaw_rate_at_rest);
  if (late)
    offset =
        offset_shown(without_late_quantity(*late, logs, description, treatment, drive, found), drive.fixes);
  if (offset && !is_filtered) treat_clock(*offset, logs, description, treatment, drive, found);
  drive.report.tells_late_quantity = found.tells_late_quantity;
  drive.report.moved_quantity = found.moved_quantity;
  drive.report.told_clock = found.told_clock;
  for (std::string& warning : found.warnings) drive.report.warnings.push_back(std::move(warning));
  return drive;
}

}  // namespace

LoggedMotion logged_motion(const DriveLogs& logs, const DriveDescription& description) {
  LoggedMotion motion;
  PrepareReport unheard;
  motion.odometries = prepare_odometry(logs, description, unheard);
  std::vector<GeodeticFix> fixes;
  for (std::size_t i = 0; i < logs.gnss.size(); ++i) {
    const std::size_t before = fixes.size();
    const DriveLogs::Log& log = logs.gnss[i];
    append_log(log.data.fixes, log, description.scale(), fixes, unheard.gnss, unheard);
    const double delay_s = receiver_of(description, i).delay_s;
    for (GeodeticFix& fix : std::span(fixes).subspan(before)) fix.stamp = fix.stamp.later(-delay_s);
  }
  clean_stream(
      fixes, unheard.gnss, [](const GeodeticFix& fix) { return finite_place(fix); },
      [](const GeodeticFix&, const GeodeticFix&) { return false; },
      [](const GeodeticFix&, const GeodeticFix&) { return false; });
  if (fixes.empty()) return motion;
  const Projection projection(
      choose_frame({fixes.front().latitude_deg, fixes.front().longitude_deg}, std::nullopt, std::nullopt));
  for (const GeodeticFix& fix : fixes) motion.fixes.push_back(projection.project(fix));
  return motion;
}

PreparedDrive prepare_on_one_clock(const DriveLogs& logs, const DriveDescription& description,
                                   ClocksApart treatment, const std::set<std::string>& suspects) {
  PreparedDrive drive;
  try {
    drive = prepare_drive(logs, description);
  } catch (const InputError&) {
    if (!logs.gnss.empty()) refuse_without_overlap(logs, description);
    throw;
  }
  if (drive.fixes.empty()) return drive;
  const PrepareReport& report = drive.report;
  if (report.fixes_outside_odometry > drive.fixes.size() + report.fixes_thinned)
    refuse_wrong_clock(logs, description);
  if (!drive.relative.empty()) return without_contradicted(std::move(drive), logs, description, suspects);
  return with_clock_told(std::move(drive), logs, description, treatment);
}

}  // namespace waymark::drive
