#include <waymark/tools/drive/logs/prepare.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/stamp_text.hpp>
#include <waymark/tools/drive/logs/clock_sync.hpp>
#include <waymark/tools/drive/logs/projection.hpp>
#include <waymark/tools/drive/logs/sensor_logs.hpp>
#include <waymark/tools/drive/logs/streams.hpp>
#include <waymark/tools/drive/logs/velocity.hpp>

namespace waymark::drive {
namespace {

std::int64_t nanoseconds(double seconds) {
  return std::llround(seconds * 1e9);
}

/// Appends the samples of one log on the scale of the drive, and its counts.
template <typename Sample>
void append_log(const std::vector<Sample>& from, const DriveLogs::Log& log, TimeScale scale,
                std::vector<Sample>& to, StreamReport& stream, PrepareReport& report) {
  const std::size_t before = to.size();
  to.insert(to.end(), from.begin(), from.end());
  put_on_scale(std::span(to).subspan(before), log, scale,
               [](Sample& sample) -> Stamp& { return sample.stamp; });
  add_log_report(log.data, stream, report);
}

bool same_number(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

bool same_place(const auto& a, const auto& b) {
  return a.latitude_deg == b.latitude_deg && a.longitude_deg == b.longitude_deg &&
         same_number(a.height_m, b.height_m);
}

bool finite_place(const auto& sample) {
  return std::isfinite(sample.latitude_deg) && std::isfinite(sample.longitude_deg);
}

/// Assembles logs with channels. @throws InputError if some are complete odometry and
/// others are not
void assemble_parts(const DriveLogs& logs, const DriveDescription& description,
                    std::vector<OdometrySample>& odometry, PrepareReport& report) {
  std::vector<OdometryPart> parts;
  for (const DriveLogs::Log& log : logs.odometry) {
    if (log.data.readings.size() == 0) continue;
    OdometryPart part{log.data.readings, log.file};
    put_on_scale(part.readings.stamps, log, description.scale(),
                 [](Stamp& stamp) -> Stamp& { return stamp; });
    parts.push_back(std::move(part));
  }
  if (parts.empty()) return;
  if (!odometry.empty())
    throw InputError(
        fmt::format("{}: some of the odometry's parts hold speed and yaw rate side by side, others channels; "
                    "leave out what is not needed",
                    description.path));
  AssembledOdometry assembled = [&] {
    try {
      return assemble_odometry(parts, description.assembly, description.timeline.gap_s);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", description.path, error.what()));
    }
  }();
  odometry = std::move(assembled.samples);
  report.notes.insert(report.notes.end(), assembled.notes.begin(), assembled.notes.end());
}

/// Notes the gaps. The motion in a gap is unknown, and no noise model fits its error.
void note_gaps(double gap_s, Stamp start, PrepareReport& report) {
  const std::vector<GapReport>& gaps = report.odometry.gaps;
  if (gaps.empty()) return;
  const GapReport& longest =
      *std::max_element(gaps.begin(), gaps.end(),
                        [](const GapReport& a, const GapReport& b) { return a.length_s < b.length_s; });
  report.notes.push_back(
      fmt::format("the odometry is silent for more than {:g} s in {} {}, the longest {:.1f} s from {:.1f} s "
                  "after its start: the speed and turn before and after are assumed there (gap: {{policy}})",
                  gap_s, gaps.size(), gaps.size() == 1 ? "place" : "places", longest.length_s,
                  seconds_between(start, longest.start)));
}

std::vector<OdometrySample> prepare_odometry(const DriveLogs& logs, const DriveDescription& description,
                                             PrepareReport& report) {
  std::vector<OdometrySample> odometry;
  for (const DriveLogs::Log& log : logs.odometry)
    append_log(log.data.odometry, log, description.scale(), odometry, report.odometry, report);
  assemble_parts(logs, description, odometry, report);
  clean_stream(
      odometry, report.odometry,
      [](const OdometrySample& s) { return std::isfinite(s.speed_mps) && std::isfinite(s.yaw_rate_radps); },
      [](const OdometrySample&, const OdometrySample&) { return true; },
      [](const OdometrySample& a, const OdometrySample& b) {
        return a.speed_mps == b.speed_mps && a.yaw_rate_radps == b.yaw_rate_radps;
      });
  if (odometry.size() < 2)
    throw InputError(fmt::format("{}: {} usable odometry samples; at least 2 are needed",
                                 logs.odometry.front().file, odometry.size()));
  if (description.speed_delay_s != 0 || description.yaw_rate_delay_s != 0)
    odometry = without_delays(odometry, description.speed_delay_s, description.yaw_rate_delay_s);
  const std::int64_t first = odometry.front().stamp.nanoseconds;
  const std::size_t before = odometry.size();
  const double length_s = seconds_between(odometry.front().stamp, odometry.back().stamp);
  std::erase_if(odometry, [&](const OdometrySample& s) {
    const std::int64_t after_first = s.stamp.nanoseconds - first;
    return (description.from_s && after_first < nanoseconds(*description.from_s)) ||
           (description.to_s && after_first > nanoseconds(*description.to_s));
  });
  report.odometry_outside_window = before - odometry.size();
  if (odometry.size() < 2)
    throw InputError(fmt::format(
        "{}: the window from {} s to {} holds {} odometry samples of a log of {:.6g} s; widen 'time: "
        "{{from, to}}' or --from and --to",
        description.path, description.from_s.value_or(0),
        description.to_s ? fmt::format("{} s", *description.to_s) : "the end", odometry.size(), length_s));
  for (const OdometrySample& sample : odometry) report.reversing += sample.speed_mps < 0;
  describe_stream(odometry, description.timeline.gap_s, report.odometry);
  note_gaps(description.timeline.gap_s, odometry.front().stamp, report);
  return odometry;
}

/// Returns "from 12.5 s to 80.25 s".
template <typename Sample>
std::string span_text(const std::vector<Sample>& samples) {
  return fmt::format("from {} s to {} s", formats::decimal_seconds(samples.front().stamp),
                     formats::decimal_seconds(samples.back().stamp));
}

/// Keeps, for each source, the fix nearest to each whole multiple of the period; the earlier of two
/// equally near ones.
void thin(std::vector<GeodeticFix>& fixes, std::int64_t period) {
  struct Nearest {
    std::size_t index = 0;
    std::int64_t distance = 0;
  };
  std::map<std::pair<int, std::int64_t>, Nearest> nearest;  // by source and multiple
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    const std::int64_t stamp = fixes[i].stamp.nanoseconds;
    std::int64_t remainder = stamp % period;
    if (remainder < 0) remainder += period;
    const bool up = 2 * remainder >= period;
    const std::int64_t multiple = (stamp - remainder) / period + (up ? 1 : 0);
    const std::int64_t distance = up ? period - remainder : remainder;
    const auto [place, is_new] = nearest.try_emplace({fixes[i].source, multiple}, Nearest{i, distance});
    if (!is_new && distance < place->second.distance) place->second = {i, distance};
  }
  std::vector<char> keep(fixes.size(), 0);
  for (const auto& [key, best] : nearest) keep[best.index] = 1;
  std::size_t index = 0;
  std::erase_if(fixes, [&](const GeodeticFix&) { return keep[index++] == 0; });
}

std::vector<InputFile> inputs_of(const DriveLogs& logs) {
  std::vector<InputFile> inputs;
  const auto add = [&inputs](const DriveLogs::Log& log) {
    inputs.insert(inputs.end(), log.inputs.begin(), log.inputs.end());
  };
  for (const DriveLogs::Log& log : logs.odometry) add(log);
  for (std::size_t i = 0; i < logs.gnss.size(); ++i) {
    add(logs.gnss[i]);
    if (i < logs.velocity.size()) add(logs.velocity[i]);
  }
  for (const DriveLogs::Log& log : logs.truth) add(log);
  for (const DriveLogs::Log& log : logs.sensors) add(log);
  return inputs;
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
  report.notes.push_back(
      fmt::format("{}: {} of {} fixes have their speed or course from it", log.file, given, fixes.size()));
}

/// Removes fixes at 0/0. Receivers without a fix write zeros, and nobody drives in the
/// Gulf of Guinea.
void leave_out_null_island(std::vector<GeodeticFix>& fixes, PrepareReport& report) {
  const std::size_t left_out = std::erase_if(
      fixes, [](const GeodeticFix& fix) { return fix.latitude_deg == 0 && fix.longitude_deg == 0; });
  if (left_out > 0)
    report.notes.push_back(fmt::format(
        "{} fixes at latitude 0, longitude 0 are left out: receivers write that without a fix", left_out));
}

std::vector<GeodeticFix> prepare_fixes(const DriveLogs& logs, const DriveDescription& description,
                                       const std::vector<OdometrySample>& odometry, PrepareReport& report) {
  std::vector<GeodeticFix> fixes;
  for (std::size_t i = 0; i < logs.gnss.size(); ++i) {
    const DriveLogs::Log& log = logs.gnss[i];
    const std::size_t before = fixes.size();
    append_log(log.data.fixes, log, description.scale(), fixes, report.gnss, report);
    if (i < logs.velocity.size() && logs.velocity[i].data.readings.size() > 0)
      add_logged_velocity(logs.velocity[i], description.scale(), std::span(fixes).subspan(before), report);
    report_clock(log, report);
  }
  leave_out_null_island(fixes, report);
  clean_stream(
      fixes, report.gnss, [](const GeodeticFix& f) { return finite_place(f) && f.covariance_en.allFinite(); },
      [](const GeodeticFix& a, const GeodeticFix& b) { return a.source == b.source; },
      [](const GeodeticFix& a, const GeodeticFix& b) {
        return same_place(a, b) && a.covariance_en == b.covariance_en && a.course_rad == b.course_rad &&
               a.speed_mps == b.speed_mps;
      });
  if (fixes.empty())
    throw InputError(fmt::format("{}: the GNSS logs hold no usable fix; a drive without a fix has no place",
                                 logs.gnss.empty() ? description.path : logs.gnss.front().file));
  for (GeodeticFix& fix : fixes) fix.stamp.nanoseconds -= nanoseconds(description.gnss_delay_s);

  const std::string gnss_span = span_text(fixes);
  const std::size_t before = fixes.size();
  std::erase_if(fixes, [&](const GeodeticFix& fix) {
    return fix.stamp < odometry.front().stamp || fix.stamp > odometry.back().stamp;
  });
  report.fixes_outside_odometry = before - fixes.size();
  if (fixes.empty())
    throw InputError(
        fmt::format("{}: no fix lies within the odometry: odometry {}, fixes {} on the scale '{}'; check "
                    "'time: {{scale, week, offset}}' of both logs and 'time: {{from, to}}'",
                    description.path, span_text(odometry), gnss_span, to_string(description.scale())));
  const std::size_t within = fixes.size();
  if (description.gnss_period_s > 0) thin(fixes, nanoseconds(description.gnss_period_s));
  report.fixes_thinned = within - fixes.size();
  describe_stream(fixes, 0, report.gnss);
  return fixes;
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

/// Numbers the epochs and withholds the requested ones. Fixes with one stamp are one epoch.
void number_epochs(std::vector<Fix>& fixes, const DriveDescription& description, PrepareReport& report) {
  int epoch = -1;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    if (i == 0 || fixes[i].stamp != fixes[i - 1].stamp) ++epoch;
    fixes[i].epoch = epoch;
    const bool nth = description.withhold_every >= 2 && (epoch + 1) % description.withhold_every == 0;
    if (!nth && !in_outage(description.outage, seconds_between(fixes.front().stamp, fixes[i].stamp)))
      continue;
    fixes[i].status = FixStatus::withheld;
    fixes[i].reason = "withheld";
    ++report.fixes_withheld;
  }
}

}  // namespace

PreparedDrive prepare_drive(const DriveLogs& logs, const DriveDescription& description) {
  PreparedDrive drive;
  drive.name = description.name;
  drive.scale = description.scale();
  drive.antenna_m = description.antenna_m;
  drive.truth_reference_m = description.truth_reference_m;
  drive.timeline = description.timeline;
  drive.inputs = inputs_of(logs);
  drive.odometry = prepare_odometry(logs, description, drive.report);
  const std::vector<GeodeticFix> fixes = prepare_fixes(logs, description, drive.odometry, drive.report);
  const std::vector<GeodeticTruth> truth = clean_truth(logs.truth, drive.scale, drive.report);
  require_overlap(truth, drive.odometry, description);

  drive.frame = choose_frame({fixes.front().latitude_deg, fixes.front().longitude_deg}, description.utm_zone,
                             description.utm_origin);
  const Projection projection(drive.frame);
  for (const GeodeticFix& fix : fixes) drive.fixes.push_back(projection.project(fix));
  for (const GeodeticTruth& pose : truth) drive.truth.push_back(projection.project(pose));
  number_epochs(drive.fixes, description, drive.report);
  for (std::size_t i = 0; i < logs.sensors.size(); ++i) {
    const SensorConfig& sensor = description.sensors[i];
    PreparedSensor& prepared = drive.sensors.emplace_back(
        PreparedSensor{.name = sensor.name, .options = sensor.options, .place = sensor.place});
    if (sensor.log)
      prepared.readings = prepare_readings(logs.sensors[i], sensor.log->request.readings, drive.scale, fixes,
                                           projection, drive.report);
  }
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
