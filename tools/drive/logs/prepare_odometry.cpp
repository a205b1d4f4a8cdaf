#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/logs/clock_sync.hpp>
#include <waymark/tools/drive/logs/prepare_steps.hpp>
#include <waymark/tools/drive/logs/streams.hpp>

namespace waymark::drive {
namespace {

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
        fmt::format("{}: some parts of the odometry hold speed and yaw rate together, others hold "
                    "channels; leave out one kind",
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
  report.notes.push_back(fmt::format(
      "the odometry has no samples for more than {:g} s in {} {}, the longest for {:.1f} s from {:.1f} s "
      "after its start: the motion there is assumed (gap: {{policy: bridge}})",
      gap_s, gaps.size(), gaps.size() == 1 ? "place" : "places", longest.length_s,
      seconds_between(start, longest.start)));
}

}  // namespace

double longest_interval_s(const DriveDescription& description, std::span<const OdometrySample> odometry) {
  constexpr double kUsualIntervals = 4;
  if (description.states_gap || odometry.size() < 2) return description.timeline.gap_s;
  std::vector<double> intervals;
  for (std::size_t i = 1; i < odometry.size(); ++i)
    intervals.push_back(seconds_between(odometry[i - 1].stamp, odometry[i].stamp));
  return std::max(description.timeline.gap_s, kUsualIntervals * upper_median(intervals));
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
  const double gap_s = longest_interval_s(description, odometry);
  describe_stream(odometry, gap_s, report.odometry);
  if (description.timeline.gap_policy == GapPolicy::bridge) note_gaps(gap_s, odometry.front().stamp, report);
  return odometry;
}

}  // namespace waymark::drive
