#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/logs/clock_offsets.hpp>
#include <waymark/tools/drive/logs/prepare_steps.hpp>
#include <waymark/tools/drive/logs/shared_stamps.hpp>
#include <waymark/tools/drive/logs/streams.hpp>
#include <waymark/tools/drive/logs/velocity.hpp>
#include <waymark/tools/drive/stamps/settle_stamps.hpp>

namespace waymark::drive {
namespace {

/// Keeps, for each source with a period, the fix nearest to each whole multiple of it; the earlier of two
/// equally near ones.
void thin(std::vector<GeodeticFix>& fixes, const DriveDescription& description) {
  struct Nearest {
    std::size_t index = 0;
    std::int64_t distance = 0;
  };
  std::map<std::pair<int, std::int64_t>, Nearest> nearest;  // by source and multiple
  std::vector<char> keep(fixes.size(), 0);
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    const double period_s = receiver_of(description, static_cast<std::size_t>(fixes[i].source)).period_s;
    if (period_s <= 0) {
      keep[i] = 1;
      continue;
    }
    const std::int64_t period = nanoseconds(period_s);
    const std::int64_t stamp = fixes[i].stamp.nanoseconds;
    std::int64_t remainder = stamp % period;
    if (remainder < 0) remainder += period;
    const bool up = 2 * remainder >= period;
    const std::int64_t multiple = (stamp - remainder) / period + (up ? 1 : 0);
    const std::int64_t distance = up ? period - remainder : remainder;
    const auto [place, is_new] = nearest.try_emplace({fixes[i].source, multiple}, Nearest{i, distance});
    if (!is_new && distance < place->second.distance) place->second = {i, distance};
  }
  for (const auto& [key, best] : nearest) keep[best.index] = 1;
  std::size_t index = 0;
  std::erase_if(fixes, [&](const GeodeticFix&) { return keep[index++] == 0; });
}

/// Reports what the messages of a log reveal about its stamps.
void report_clock(const DriveLogs::Log& log, PrepareReport& report) {
  const std::optional<ClockReport> clock = clock_of(log);
  if (!clock) return;
  report.clocks.push_back(*clock);
  report.notes.push_back(fmt::format(
      "{}: its stamps are {:.3f} s ahead of the GNSS time in {} messages (median, deviations {:.3f} s), "
      "with the stated 'time: {{offset: ...}}' added",
      log.file, clock->ahead_s, clock->messages, clock->spread_s));
}

void add_logged_velocity(const DriveLogs::Log& log, TimeScale scale, std::span<GeodeticFix> fixes,
                         PrepareReport& report) {
  SensorTable readings = log.data.readings;
  put_on_scale(readings.stamps, log, scale, [](Stamp& stamp) -> Stamp& { return stamp; });
  add_log_report(log.data, report.sensor, report);
  const std::size_t given = add_velocity(readings, fixes);
  report.notes.push_back(fmt::format("{}: {} of {} fixes take their speed or course from this log", log.file,
                                     given, fixes.size()));
}

/// Removes fixes at 0/0. Receivers without a fix write zeros, and nobody drives in the
/// Gulf of Guinea.
void leave_out_null_island(std::vector<GeodeticFix>& fixes, PrepareReport& report) {
  const std::size_t left_out = std::erase_if(
      fixes, [](const GeodeticFix& fix) { return fix.latitude_deg == 0 && fix.longitude_deg == 0; });
  if (left_out > 0)
    report.notes.push_back(fmt::format(
        "{} fixes at latitude 0, longitude 0 are left out: receivers without a fix write them", left_out));
}

/// @throws InputError with its place if a stated delay alone moves the fixes out of the odometry
void require_short_delays(const DriveDescription& description, std::size_t receivers,
                          const std::vector<OdometrySample>& odometry) {
  const double span_s = seconds_between(odometry.front().stamp, odometry.back().stamp);
  for (std::size_t i = 0; i < receivers; ++i) {
    const GnssConfig& receiver = receiver_of(description, i);
    if (std::abs(receiver.delay_s) > span_s)
      throw InputError(fmt::format(
          "{}delay: {:g} s is longer than the odometry, {:.6g} s, and no fix lies within it; a delay is how late "
          "the stamps of the fixes are, and 'time: {{offset}}' moves a whole log",
          receiver.delay_place, receiver.delay_s, span_s));
  }
}

/// Warns if much of the drive has fixes and no odometry: a log that is cut off, or a clock that is another one at one
/// end. What a stated stretch of the drive leaves out is meant to be.
void warn_of_fixes_outside(const std::vector<GeodeticFix>& fixes, const std::vector<OdometrySample>& odometry,
                           const DriveDescription& description, PrepareReport& report) {
  constexpr std::size_t kOneIn = 10;
  constexpr std::size_t kFewest = 10;
  const auto count = [&](const auto& is_outside) {
    return static_cast<std::size_t>(std::count_if(fixes.begin(), fixes.end(), is_outside));
  };
  const std::size_t before =
      description.from_s ? 0 : count([&](const auto& fix) { return fix.stamp < odometry.front().stamp; });
  const std::size_t behind =
      description.to_s ? 0 : count([&](const auto& fix) { return fix.stamp > odometry.back().stamp; });
  if (before + behind < kFewest || kOneIn * (before + behind) <= fixes.size()) return;
  std::string where;
  if (before > 0)
    where += fmt::format("{} of {} fixes lie up to {:.0f} s before the odometry", before, fixes.size(),
                         seconds_between(fixes.front().stamp, odometry.front().stamp));
  if (behind > 0)
    where +=
        fmt::format("{}{} of {} fixes lie up to {:.0f} s behind the odometry", where.empty() ? "" : ", and ",
                    behind, fixes.size(), seconds_between(odometry.back().stamp, fixes.back().stamp));
  report.warnings.push_back(fmt::format(
      "{}: they are left out, because no motion is known there; name all logs of the odometry, or check 'time: "
      "{{scale, week, offset}}' of both logs",
      where));
}

}  // namespace

const GnssConfig& receiver_of(const DriveDescription& description, std::size_t source) {
  static const GnssConfig kNothingStated;
  return source < description.gnss.size() ? description.gnss[source] : kNothingStated;
}

std::vector<GeodeticFix> prepare_fixes(const DriveLogs& logs, const DriveDescription& description,
                                       const std::vector<OdometrySample>& odometry, PrepareReport& report) {
  std::vector<GeodeticFix> fixes;
  if (logs.gnss.empty() && description.gnss.empty()) return fixes;
  for (std::size_t i = 0; i < logs.gnss.size(); ++i) {
    const DriveLogs::Log& log = logs.gnss[i];
    const std::size_t before = fixes.size();
    append_log(log.data.fixes, log, description.scale(), fixes, report.gnss, report);
    settle_shared_stamps(std::span(fixes).subspan(before), log.file, report);
    settle_bursts(std::span(fixes).subspan(before), log.file, report);
    if (std::string warning = warning_of_turns(std::span(fixes).subspan(before), log.file); !warning.empty())
      report.warnings.push_back(std::move(warning));
    if (i < logs.velocity.size() && logs.velocity[i].data.readings.size() > 0)
      add_logged_velocity(logs.velocity[i], description.scale(), std::span(fixes).subspan(before), report);
    report_clock(log, report);
    const std::int64_t delay = nanoseconds(receiver_of(description, i).delay_s);
    for (GeodeticFix& fix : std::span(fixes).subspan(before)) fix.stamp.nanoseconds -= delay;
  }
  leave_out_null_island(fixes, report);
  clean_stream(
      fixes, report.gnss, [](const GeodeticFix& f) { return finite_place(f) && f.covariance_en.allFinite(); },
      [](const GeodeticFix& a, const GeodeticFix& b) { return a.source == b.source; },
      [](const GeodeticFix& a, const GeodeticFix& b) {
        return same_place(a, b) && a.covariance_en == b.covariance_en && a.course_rad == b.course_rad &&
               a.speed_mps == b.speed_mps;
      });
  note_cleaning("fixes", report.gnss, report);
  if (fixes.empty())
    throw InputError(fmt::format("{}: the GNSS logs hold no usable fix; a drive needs at least one",
                                 logs.gnss.empty() ? description.path : logs.gnss.front().file));

  const std::string gnss_span = span_text(fixes);
  warn_of_fixes_outside(fixes, odometry, description, report);
  const std::size_t before = fixes.size();
  std::erase_if(fixes, [&](const GeodeticFix& fix) {
    return fix.stamp < odometry.front().stamp || fix.stamp > odometry.back().stamp;
  });
  report.fixes_outside_odometry = before - fixes.size();
  if (fixes.empty()) require_short_delays(description, logs.gnss.size(), odometry);
  if (fixes.empty())
    throw InputError(
        fmt::format("{}: no fix lies within the odometry: odometry {}, fixes {} on the scale '{}'; check "
                    "'time: {{scale, week, offset}}' of both logs and 'time: {{from, to}}'",
                    description.path, span_text(odometry), gnss_span, to_string(description.scale())));
  const std::size_t within = fixes.size();
  thin(fixes, description);
  report.fixes_thinned = within - fixes.size();
  describe_stream(fixes, 0, report.gnss);
  return fixes;
}

}  // namespace waymark::drive
