#include <waymark/tools/drive/clocks/clock_check.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/common/gps_time.hpp>
#include <waymark/tools/drive/clocks/clock_sync.hpp>
#include <waymark/tools/drive/clocks/lag_search.hpp>
#include <waymark/tools/drive/coordinates/projection.hpp>
#include <waymark/tools/drive/logs/prepare_steps.hpp>
#include <waymark/tools/drive/logs/streams.hpp>
#include <waymark/tools/drive/nodes/plausibility.hpp>

namespace waymark::drive {
namespace {

constexpr double kWeek_s = formats::kGpsWeekNanoseconds / 1e9;
constexpr double kRollover_s = 1024 * kWeek_s;
constexpr double kGpsEpoch_s = formats::kGpsEpochPosix / 1e9;
constexpr double kHalfHour_s = 1800;
constexpr double kMostZone_s = 14 * 3600;

/// An offset that has a name.
struct Known {
  double seconds;
  std::string name;
};

/// Returns the large offsets nearest to one, and none at all: leap seconds may be beside each.
std::vector<Known> large_offsets(double seconds) {
  std::vector<Known> known = {{0, ""}};
  const double sign = seconds < 0 ? -1 : 1;
  known.push_back({sign * kGpsEpoch_s, "the GPS epoch against the Unix epoch"});
  const double weeks = std::round(seconds / kWeek_s);
  const double rollovers = std::round(seconds / kRollover_s);
  if (rollovers != 0)
    known.push_back({rollovers * kRollover_s, fmt::format("{} GPS weeks (a rollover of the week number)",
                                                          1024 * std::abs(rollovers))});
  if (weeks != 0 && std::abs(weeks) < 4000)
    known.push_back({weeks * kWeek_s, std::abs(weeks) == 1 ? std::string("a GPS week")
                                                           : fmt::format("{} GPS weeks", std::abs(weeks))});
  const double zone = std::round(seconds / kHalfHour_s) * kHalfHour_s;
  if (zone != 0 && std::abs(zone) <= kMostZone_s)
    known.push_back({zone, fmt::format("{:g} h of a time zone", std::abs(zone) / 3600)});
  return known;
}

/// Empty: it is no number of leap seconds. GPS time has been ahead of UTC by 13 s from 1999, 18 s from 2017.
std::optional<std::string> leap_name(double seconds, double tolerance_s) {
  const double count = std::round(std::abs(seconds));
  if (std::abs(std::abs(seconds) - count) > tolerance_s) return std::nullopt;
  if (count == 0) return "";
  if (count < 13 || count > 18) return std::nullopt;
  return fmt::format("{} leap seconds (GPS time against UTC)", count);
}

/// The offset at which speed and yaw rate fit best: the one that is known better.
std::optional<ClockOffset> common_offset(const SyncReport& report) {
  if (!report.speed) return report.yaw_rate;
  return report.yaw_rate && report.yaw_rate->sigma_s < report.speed->sigma_s ? report.yaw_rate : report.speed;
}

std::string remedy(const ClockOffset& offset) {
  return fmt::format("--sync applies it; or state 'time: {{offset: {:.2f}}}' for the logs of 'odometry'",
                     -offset.late_s);
}

/// Returns the offset at which all that is logged fits best. Empty: it fits nowhere.
std::optional<ClockOffset> logged_offset(const LoggedMotion& motion) {
  return common_offset(estimate_clock_offsets(motion.odometry, motion.fixes, {}));
}

/// Returns why no fixes, or few, lie within the odometry.
std::string explanation(const LoggedMotion& motion, const std::optional<ClockOffset>& offset) {
  if (offset)
    return fmt::format("the motion of both fits if the odometry's clock is {:.2f} s late{}: {}",
                       offset->late_s, offset_in_words(*offset), remedy(*offset));
  const double apart = seconds_between(motion.fixes.front().stamp, motion.odometry.front().stamp);
  const std::string name = name_of_offset(apart, 600);
  if (!name.empty()) return fmt::format("they begin {:.0f} s apart, which is near {}", apart, name);
  return "their motion fits at no other offset; check 'time: {scale, week, offset}' of both logs and 'time: "
         "{from, to}'";
}

bool lies_within(const Fix& fix, const std::vector<OdometrySample>& odometry) {
  return fix.stamp >= odometry.front().stamp && fix.stamp <= odometry.back().stamp;
}

[[noreturn]] void refuse(const LoggedMotion& motion, const std::optional<ClockOffset>& offset,
                         const DriveDescription& description) {
  const auto outside = std::count_if(motion.fixes.begin(), motion.fixes.end(),
                                     [&](const Fix& fix) { return !lies_within(fix, motion.odometry); });
  throw InputError(
      fmt::format("{}: {} of {} fixes lie outside the odometry: odometry {}, fixes {} on the "
                  "scale '{}'; {}",
                  description.path, outside, motion.fixes.size(), span_text(motion.odometry),
                  span_text(motion.fixes), to_string(description.scale()), explanation(motion, offset)));
}

/// @throws InputError if no fix lies within the odometry
void refuse_without_overlap(const DriveLogs& logs, const DriveDescription& description) {
  const LoggedMotion motion = logged_motion(logs, description);
  const auto within = [&](const Fix& fix) { return lies_within(fix, motion.odometry); };
  if (!motion.fixes.empty() && std::none_of(motion.fixes.begin(), motion.fixes.end(), within))
    refuse(motion, logged_offset(motion), description);
}

/// @throws InputError if most fixes lie outside the odometry, and the motion of both fits elsewhere
void refuse_wrong_clock(const DriveLogs& logs, const DriveDescription& description) {
  const LoggedMotion motion = logged_motion(logs, description);
  const std::optional<ClockOffset> offset = logged_offset(motion);
  constexpr double kOneClock_s = 2;
  if (offset && std::abs(offset->late_s) > kOneClock_s) refuse(motion, offset, description);
}

/// The default model finds fixes that are late by less than the first of these itself. Odometry that is late it
/// finds in part only, because receivers are not early.
constexpr double kLateFixes_s = 0.3;
constexpr double kLateOdometry_s = 0.2;

bool is_near_zero(double late_s) {
  return late_s > -kLateFixes_s && late_s < kLateOdometry_s;
}

/// Compares the neighbourhood of zero with a minute about it, and with everything if nothing fits at zero.
bool fits_elsewhere(const LagSearch& search) {
  constexpr double kFar_s = 60;
  constexpr double kLead = 12;
  constexpr double kFits = 0.5;
  const std::optional<Lag> near = search.best(-kLateFixes_s, kLateOdometry_s);
  const std::optional<Lag> far = search.best(-kFar_s, kFar_s);
  if (!near || !far) return false;
  const bool better = !is_near_zero(far->late_s) && far->score > near->score + kLead;
  const bool fits = std::max(near->speed_correlation, near->turn_correlation) > kFits;
  return better || !fits;
}

constexpr std::size_t kFewestCompared = 30;  // fixes, and samples

/// Returns the offset of the clock of an odometry, if the fixes show that it has one.
std::optional<ClockOffset> offset_shown(const std::vector<OdometrySample>& odometry,
                                        const std::vector<Fix>& fixes) {
  if (fixes.size() < kFewestCompared || odometry.size() < kFewestCompared) return std::nullopt;
  const std::vector<const Fix*> receiver = of_one_receiver(fixes);
  const auto [speeds, turns] = receiver_motion(receiver);
  if (!fits_elsewhere(LagSearch(odometry, speeds, turns))) return std::nullopt;
  const std::optional<ClockOffset> offset = common_offset(estimate_clock_offsets(odometry, fixes, {}));
  if (!offset || !offset->is_significant() || is_near_zero(offset->late_s)) return std::nullopt;
  return offset;
}

/// @param odometry "the odometry" or the name of one of several @param cure what to do
std::string clock_warning(const std::string& odometry, const ClockOffset& offset, const std::string& cure) {
  return fmt::format("{}'s clock seems {:.2f} +- {:.2f} s late against the fixes{}, correlation {:.3f}: {}",
                     odometry, offset.late_s, std::hypot(offset.sigma_s, kSmoothing_s),
                     offset_in_words(offset), offset.correlation, cure);
}

/// Returns what the fixes of the first receiver say against an odometry beside the one of the nodes.
std::vector<std::string> warnings_of(const PreparedOdometry& source, const PreparedDrive& drive) {
  const std::vector<OdometrySample>& samples = source.samples;
  std::vector<Fix> fixes;
  for (const Fix& fix : drive.fixes)
    if (fix.source == drive.fixes.front().source && fix.stamp >= samples.front().stamp &&
        fix.stamp <= samples.back().stamp)
      fixes.push_back(fix);
  if (fixes.size() < kFewestCompared || samples.size() < kFewestCompared) return {};
  if (const std::optional<ClockOffset> offset = offset_shown(samples, fixes))
    return {clock_warning(source.name, *offset,
                          fmt::format("state 'time: {{offset: {:.2f}}}' for its log", -offset->late_s))};
  constexpr double kStands_mps = 0.01;
  const Timeline timeline = build_timeline(samples, fixes, {.gap_s = source.gap_s});
  const std::vector<Eigen::Vector3d> poses = dead_reckon(timeline, Eigen::Vector3d::Zero(), kStands_mps);
  std::vector<std::string> warnings;
  for (const std::string& shape : compare_shapes(fixes, antenna_at_fixes(timeline, poses, fixes)))
    warnings.push_back(source.name + ": " + shape);
  return warnings;
}

}  // namespace

std::string name_of_offset(double seconds, double tolerance_s) {
  for (const Known& known : large_offsets(seconds)) {
    const std::optional<std::string> leap = leap_name(seconds - known.seconds, tolerance_s);
    if (!leap) {
      if (known.seconds != 0 && std::abs(seconds - known.seconds) <= tolerance_s) return known.name;
      continue;
    }
    if (known.name.empty() && leap->empty()) continue;
    return known.name + (known.name.empty() || leap->empty() ? "" : " and ") + *leap;
  }
  return {};
}

std::string offset_in_words(const ClockOffset& offset) {
  const std::string name = name_of_offset(offset.late_s, std::clamp(3 * offset.sigma_s, 0.5, 5.0));
  return name.empty() ? "" : ", " + name;
}

LoggedMotion logged_motion(const DriveLogs& logs, const DriveDescription& description) {
  LoggedMotion motion;
  PrepareReport unheard;
  PreparedOdometry odometry = std::move(prepare_odometry(logs, description, unheard).front());
  motion.source = odometry.name;
  motion.odometry = std::move(odometry.samples);
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

PreparedDrive prepare_on_one_clock(const DriveLogs& logs, const DriveDescription& description) {
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
  std::vector<std::string>& warnings = drive.report.warnings;
  if (const std::optional<ClockOffset> offset = offset_shown(drive.odometry, drive.fixes))
    warnings.push_back(clock_warning("the odometry", *offset, remedy(*offset)));
  for (std::size_t source = 1; source < drive.relative.size(); ++source)
    for (std::string& warning : warnings_of(drive.relative[source], drive))
      warnings.push_back(std::move(warning));
  return drive;
}

}  // namespace waymark::drive
