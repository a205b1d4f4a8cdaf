#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>

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
void assemble_parts(const std::vector<DriveLogs::Log>& logs, const OdometryAssembly& assembly,
                    const DriveDescription& description, std::vector<OdometrySample>& odometry,
                    PrepareReport& report) {
  std::vector<OdometryPart> parts;
  for (const DriveLogs::Log& log : logs) {
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
      return assemble_odometry(parts, assembly, description.timeline.gap_s);
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

/// Reads one source: cleaned, without its delays.
std::vector<OdometrySample> samples_of(const std::vector<DriveLogs::Log>& logs, const OdometryConfig& config,
                                       const DriveDescription& description, StreamReport& stream,
                                       PrepareReport& report) {
  std::vector<OdometrySample> samples;
  for (const DriveLogs::Log& log : logs)
    append_log(log.data.odometry, log, description.scale(), samples, stream, report);
  assemble_parts(logs, config.assembly, description, samples, report);
  clean_stream(
      samples, stream,
      [](const OdometrySample& s) { return std::isfinite(s.speed_mps) && std::isfinite(s.yaw_rate_radps); },
      [](const OdometrySample&, const OdometrySample&) { return true; },
      [](const OdometrySample& a, const OdometrySample& b) {
        return a.speed_mps == b.speed_mps && a.yaw_rate_radps == b.yaw_rate_radps;
      });
  if (samples.size() < 2)
    throw InputError(fmt::format("{}: {} usable odometry samples; at least 2 are needed", logs.front().file,
                                 samples.size()));
  if (config.speed_delay_s != 0 || config.yaw_rate_delay_s != 0)
    samples = without_delays(samples, config.speed_delay_s, config.yaw_rate_delay_s);
  return samples;
}

/// Cuts samples to the window of the drive. @param first stamp of the drive
/// @returns how many are outside
std::size_t cut_to_window(Stamp first, const DriveDescription& description,
                          std::vector<OdometrySample>& samples) {
  return std::erase_if(samples, [&](const OdometrySample& s) {
    const std::int64_t after_first = s.stamp.nanoseconds - first.nanoseconds;
    return (description.from_s && after_first < nanoseconds(*description.from_s)) ||
           (description.to_s && after_first > nanoseconds(*description.to_s));
  });
}

void require_window(const std::vector<OdometrySample>& samples, double length_s,
                    const DriveDescription& description) {
  if (samples.size() >= 2) return;
  throw InputError(fmt::format(
      "{}: the window from {} s to {} holds {} odometry samples of a log of {:.6g} s; widen 'time: "
      "{{from, to}}' or --from and --to",
      description.path, description.from_s.value_or(0),
      description.to_s ? fmt::format("{} s", *description.to_s) : "the end", samples.size(), length_s));
}

/// Puts the source of the nodes first: the stated one, else the densest.
void put_first(const DriveDescription& description, std::vector<PreparedOdometry>& relative,
               std::vector<StreamReport>& streams) {
  std::size_t first = 0;
  for (std::size_t i = 1; i < relative.size(); ++i) {
    const bool is_denser = streams[i].median_interval_s < streams[first].median_interval_s;
    const bool stated = description.odometry[first].gives_nodes;
    if (description.odometry[i].gives_nodes || (is_denser && !stated)) first = i;
  }
  std::rotate(relative.begin(), relative.begin() + static_cast<std::ptrdiff_t>(first),
              relative.begin() + static_cast<std::ptrdiff_t>(first) + 1);
  std::rotate(streams.begin(), streams.begin() + static_cast<std::ptrdiff_t>(first),
              streams.begin() + static_cast<std::ptrdiff_t>(first) + 1);
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

std::vector<PreparedOdometry> prepare_odometry(const DriveLogs& logs, const DriveDescription& description,
                                               PrepareReport& report) {
  std::vector<PreparedOdometry> relative;
  std::vector<StreamReport> streams(logs.odometry.size());
  Stamp first{std::numeric_limits<std::int64_t>::max()};
  for (std::size_t i = 0; i < logs.odometry.size(); ++i) {
    const OdometryConfig config =
        i < description.odometry.size() ? description.odometry[i] : OdometryConfig();
    relative.push_back(
        {config.name, samples_of(logs.odometry[i], config, description, streams[i], report), 0, {}});
    first = std::min(first, relative.back().samples.front().stamp);
  }
  for (std::size_t i = 0; i < relative.size(); ++i) {
    std::vector<OdometrySample>& samples = relative[i].samples;
    const double length_s = seconds_between(samples.front().stamp, samples.back().stamp);
    report.odometry_outside_window += cut_to_window(first, description, samples);
    require_window(samples, length_s, description);
    relative[i].gap_s = longest_interval_s(description, samples);
    relative[i].yaw_rate_at_rest = yaw_rate_at_rest(samples);
    describe_stream(samples, relative[i].gap_s, streams[i]);
  }
  put_first(description, relative, streams);
  for (const OdometrySample& sample : relative.front().samples) report.reversing += sample.speed_mps < 0;
  report.odometry = streams.front();
  for (std::size_t i = 1; i < relative.size(); ++i) {
    report.odometry.corrupt += streams[i].corrupt;
    report.notes.push_back(fmt::format("{}: {} samples, usually {:.3g} s apart; nodes come from {}",
                                       relative[i].name, streams[i].used, streams[i].median_interval_s,
                                       relative.front().name));
  }
  const std::vector<OdometrySample>& main = relative.front().samples;
  if (relative.size() == 1 && description.timeline.gap_policy == GapPolicy::bridge)
    note_gaps(relative.front().gap_s, main.front().stamp, report);
  return relative;
}

std::vector<OdometrySample> covered_by_all(const std::vector<PreparedOdometry>& relative,
                                           std::size_t& added) {
  std::vector<OdometrySample> all = relative.front().samples;
  const std::size_t before = all.size();
  double gap_s = relative.front().gap_s;
  for (std::size_t i = 1; i < relative.size(); ++i) {
    std::vector<OdometrySample> more;
    std::size_t next = 0;  // the first sample of `all` that is not earlier
    for (const OdometrySample& sample : relative[i].samples) {
      while (next < all.size() && all[next].stamp < sample.stamp) ++next;
      const bool meets = next < all.size() && all[next].stamp == sample.stamp;
      const bool covered =
          next > 0 && next < all.size() && seconds_between(all[next - 1].stamp, all[next].stamp) <= gap_s;
      if (!meets && !covered) more.push_back(sample);
    }
    std::vector<OdometrySample> merged;
    std::merge(all.begin(), all.end(), more.begin(), more.end(), std::back_inserter(merged),
               [](const OdometrySample& a, const OdometrySample& b) { return a.stamp < b.stamp; });
    all = std::move(merged);
    gap_s = std::max(gap_s, relative[i].gap_s);
  }
  added = all.size() - before;
  return all;
}

}  // namespace waymark::drive
