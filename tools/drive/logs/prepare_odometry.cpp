#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <set>
#include <span>
#include <string>

#include <fmt/format.h>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/channels.hpp>
#include <waymark/formats/logs/detail/csv/composed.hpp>
#include <waymark/tools/drive/logs/clock_offsets.hpp>
#include <waymark/tools/drive/logs/prepare_steps.hpp>
#include <waymark/tools/drive/logs/streams.hpp>
#include <waymark/tools/drive/stamps/clock_steps.hpp>
#include <waymark/tools/drive/stamps/settle_stamps.hpp>

namespace waymark::drive {
namespace {

/// Returns the channels of a log that its description does not name, although it names others.
std::set<std::string, std::less<>> channels_by_default(const LogRequest& request) {
  std::set<std::string, std::less<>> unstated;
  for (const SensorColumn& channel : formats::odometry_channels())
    if (!formats::names_columns_of(request, channel.name)) unstated.insert(channel.name);
  if (unstated.size() == formats::odometry_channels().size()) unstated.clear();
  return unstated;
}

/// Takes back the steps of a clock that was set, and tells where else the stamps do not go on. @param stamps of a log
void settle_clock(std::span<Stamp> stamps, std::size_t logs, const OdometryConfig& config,
                  PrepareReport& report) {
  if (logs != 1) return;
  take_back(config.clock_steps, stamps);
  report.stamp_steps = find_stamp_steps(stamps);
}

/// Assembles logs with channels. @throws InputError if some are complete odometry and
/// others are not
void assemble_parts(const std::vector<DriveLogs::Log>& logs, const OdometryConfig& config,
                    const DriveDescription& description, PreparedOdometry& source, PrepareReport& report) {
  std::vector<OdometrySample>& odometry = source.samples;
  std::vector<OdometryPart> parts;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    const DriveLogs::Log& log = logs[i];
    if (log.data.readings.size() == 0) continue;
    OdometryPart part{log.data.readings, log.file};
    if (i < config.logs.size()) part.by_default = channels_by_default(config.logs[i].request);
    put_on_scale(part.readings.stamps, log, description.scale(),
                 [](Stamp& stamp) -> Stamp& { return stamp; });
    settle_clock(part.readings.stamps, logs.size(), config, report);
    settle_stamps(part.readings, log.file, report);
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
      return assemble_odometry(parts, config.assembly, description.timeline.gap_s);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", description.path, error.what()));
    }
  }();
  odometry = std::move(assembled.samples);
  source.yaw_rate_at_rest.stated_derived = is_from_wheels_or_steering(assembled.yaw_rate_from);
  report.notes.insert(report.notes.end(), assembled.notes.begin(), assembled.notes.end());
  report.warnings.insert(report.warnings.end(), assembled.warnings.begin(), assembled.warnings.end());
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

/// Yaw rates that no vehicle has are garbage and are left out, unless they are those of turns in deg/s: then what the
/// fixes show of them is named (misreading.hpp), or this is.
/// @param source name of the odometry
void drop_impossible_turns(const std::string& source, const std::string& file, StreamReport& stream,
                           std::vector<OdometrySample>& samples, PrepareReport& report) {
  constexpr double kFastest_radps = 20;
  constexpr double kTurn_degps = 120;
  constexpr std::size_t kFewest = 20;
  constexpr std::size_t kOneIn = 100;
  const auto is_beyond = [](const OdometrySample& s, double limit) {
    return std::isfinite(s.yaw_rate_radps) && std::abs(s.yaw_rate_radps) > limit;
  };
  std::size_t impossible = 0;
  std::size_t faster = 0;
  for (const OdometrySample& sample : samples) {
    impossible += is_beyond(sample, kFastest_radps);
    faster += is_beyond(sample, kTurn_degps);
  }
  if (impossible == 0) return;
  if (10 * faster < impossible && impossible >= kFewest && kOneIn * impossible >= samples.size()) {
    report.impossible_turns[source] = fmt::format(
        "{} of {} yaw rates of '{}' are beyond {:g} rad/s, which no vehicle turns: deg/s read as rad/s? State "
        "'unit: deg/s' of the yaw rate",
        impossible, samples.size(), file, kFastest_radps);
    return;
  }
  std::erase_if(samples, [&](const OdometrySample& s) { return is_beyond(s, kFastest_radps); });
  stream.corrupt += impossible;
  report.corrupt_examples.push_back(
      fmt::format("{}: {} yaw rates beyond {:g} rad/s", file, impossible, kFastest_radps));
}

/// Warns of an odometry that loses much by stamps that several samples have, of other readings.
void warn_of_shared_stamps(const std::string& file, const StreamReport& stream, PrepareReport& report) {
  constexpr std::size_t kOneIn = 10;
  if (kOneIn * stream.duplicates_conflicting < stream.read || stream.duplicates_conflicting == 0) return;
  report.warnings.push_back(fmt::format(
      "{}: {} of {} odometry samples share their stamp with another reading and are left out: stamps that "
      "are cut off, or two sources in one log; log all digits of the stamps, or give each source a log of "
      "its own",
      file, stream.duplicates_conflicting, stream.read));
}

/// Reads one source: cleaned, without its delays. Fewer than two samples are no motion.
void read_source(const std::vector<DriveLogs::Log>& logs, const OdometryConfig& config,
                 const DriveDescription& description, PreparedOdometry& source, StreamReport& stream,
                 PrepareReport& report) {
  std::vector<OdometrySample>& samples = source.samples;
  for (const DriveLogs::Log& log : logs) {
    const std::size_t before = samples.size();
    append_log(log.data.odometry, log, description.scale(), samples, stream, report);
    std::vector<Stamp> stamps;
    for (const OdometrySample& sample : std::span(samples).subspan(before)) stamps.push_back(sample.stamp);
    settle_clock(stamps, logs.size(), config, report);
    for (std::size_t i = 0; i < stamps.size(); ++i) samples[before + i].stamp = stamps[i];
    settle_stamps(samples, before, log.file, report);
  }
  source.yaw_rate_at_rest.stated_derived = is_from_wheels_or_steering(config.assembly.yaw_rate_from);
  assemble_parts(logs, config, description, source, report);
  drop_impossible_turns(source.name, logs.front().file, stream, samples, report);
  clean_stream(
      samples, stream,
      [](const OdometrySample& s) { return std::isfinite(s.speed_mps) && std::isfinite(s.yaw_rate_radps); },
      [](const OdometrySample&, const OdometrySample&) { return true; },
      [](const OdometrySample& a, const OdometrySample& b) {
        return a.speed_mps == b.speed_mps && a.yaw_rate_radps == b.yaw_rate_radps;
      });
  note_cleaning("odometry samples", stream, report);
  warn_of_shared_stamps(logs.front().file, stream, report);
  if (samples.size() < 2) return;
  if (config.speed_delay_s != 0 || config.yaw_rate_delay_s != 0)
    samples = without_delays(samples, config.speed_delay_s, config.yaw_rate_delay_s);
}

/// A relative source while it is prepared.
struct RelativeCandidate {
  PreparedOdometry source;
  StreamReport stream;
  std::string file;          ///< its first log
  bool gives_nodes = false;  ///< stated
  double length_s = 0;       ///< before it is cut to the window of the drive
  std::string flaw{};        ///< why it is not usable; empty: it is
};

RelativeCandidate candidate_of(const std::vector<DriveLogs::Log>& logs, const OdometryConfig& config,
                               const DriveDescription& description, PrepareReport& report) {
  RelativeCandidate candidate{.source = {config.name, {}, 0, {}},
                              .stream = {},
                              .file = logs.front().file,
                              .gives_nodes = config.gives_nodes};
  std::vector<OdometrySample>& samples = candidate.source.samples;
  read_source(logs, config, description, candidate.source, candidate.stream, report);
  const bool had_motion = candidate.stream.read >= 2;
  if (samples.size() < 2 && had_motion && !config.delay_place.empty()) {
    candidate.flaw = fmt::format(
        "{}speed_delay {:g} s and yaw_rate_delay {:g} s leave {} samples of speed and yaw rate at one instant: "
        "they differ by more than {} is long",
        config.delay_place, config.speed_delay_s, config.yaw_rate_delay_s, samples.size(), candidate.file);
  } else if (samples.size() < 2) {
    candidate.flaw =
        fmt::format("{}: {} usable odometry samples; at least 2 are needed", candidate.file, samples.size());
  } else {
    candidate.length_s = seconds_between(samples.front().stamp, samples.back().stamp);
  }
  return candidate;
}

/// Names the first interval between samples that is longer than a day: a wrong digit, or a clock that was
/// set. Bridged, it would have a state of each kind for every few seconds. Empty if there is none.
std::string leap_of(const std::vector<OdometrySample>& samples, const std::string& file) {
  constexpr double kLongest_s = 86'400;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double leap_s = seconds_between(samples[i - 1].stamp, samples[i].stamp);
    if (leap_s > kLongest_s)
      return fmt::format(
          "{}: the stamps leap by {:.6g} s after {:.9g} s of the log, where {} of its {} samples have passed: a "
          "wrong stamp, or a clock that was set; correct it, or keep one side by 'time: {{from, to}}' or --from "
          "and --to",
          file, leap_s, seconds_between(samples.front().stamp, samples[i - 1].stamp), i, samples.size());
  }
  return {};
}

/// Cuts samples to the window of the drive. @param first stamp of the drive
void cut_to_window(Stamp first, const DriveDescription& description, RelativeCandidate& candidate,
                   PrepareReport& report) {
  std::vector<OdometrySample>& samples = candidate.source.samples;
  report.odometry_outside_window += std::erase_if(samples, [&](const OdometrySample& s) {
    const std::int64_t after_first = s.stamp.nanoseconds - first.nanoseconds;
    return (description.from_s && after_first < nanoseconds(*description.from_s)) ||
           (description.to_s && after_first > nanoseconds(*description.to_s));
  });
  if (samples.size() >= 2) {
    candidate.flaw = leap_of(samples, candidate.file);
    return;
  }
  candidate.flaw = fmt::format(
      "{}: the window from {} s to {} holds {} odometry samples of a log of {:.6g} s; widen 'time: "
      "{{from, to}}' or --from and --to",
      description.path, description.from_s.value_or(0),
      description.to_s ? fmt::format("{} s", *description.to_s) : "the end", samples.size(),
      candidate.length_s);
}

/// Leaves out the sources without motion. @throws InputError if no other one is left
void leave_out_unusable(std::vector<RelativeCandidate>& candidates, PrepareReport& report) {
  const auto is_unusable = [](const RelativeCandidate& candidate) { return !candidate.flaw.empty(); };
  if (std::all_of(candidates.begin(), candidates.end(), is_unusable))
    throw InputError(candidates.front().flaw);
  for (const RelativeCandidate& candidate : candidates)
    if (is_unusable(candidate))
      report.warnings.push_back(candidate.source.name + " is left out: " + candidate.flaw);
  std::erase_if(candidates, is_unusable);
}

/// Puts the source of the nodes first: the stated one, else the densest.
void put_first(std::vector<RelativeCandidate>& candidates) {
  std::size_t first = 0;
  for (std::size_t i = 1; i < candidates.size(); ++i) {
    const bool is_denser =
        candidates[i].stream.median_interval_s < candidates[first].stream.median_interval_s;
    if (candidates[i].gives_nodes || (is_denser && !candidates[first].gives_nodes)) first = i;
  }
  const auto begin = candidates.begin();
  std::rotate(begin, begin + static_cast<std::ptrdiff_t>(first),
              begin + static_cast<std::ptrdiff_t>(first) + 1);
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
  std::vector<RelativeCandidate> candidates;
  Stamp first{std::numeric_limits<std::int64_t>::max()};
  for (std::size_t i = 0; i < logs.odometry.size(); ++i) {
    const OdometryConfig config =
        i < description.odometry.size() ? description.odometry[i] : OdometryConfig();
    candidates.push_back(candidate_of(logs.odometry[i], config, description, report));
    if (candidates.back().flaw.empty())
      first = std::min(first, candidates.back().source.samples.front().stamp);
  }
  for (RelativeCandidate& candidate : candidates)
    if (candidate.flaw.empty()) cut_to_window(first, description, candidate, report);
  leave_out_unusable(candidates, report);
  for (RelativeCandidate& candidate : candidates) {
    PreparedOdometry& source = candidate.source;
    source.gap_s = longest_interval_s(description, source.samples);
    mark_turns_on_spot(source.samples);
    source.yaw_rate_at_rest = yaw_rate_at_rest(source.samples, source.yaw_rate_at_rest.stated_derived);
    describe_stream(source.samples, source.gap_s, candidate.stream);
  }
  put_first(candidates);
  const PreparedOdometry& main = candidates.front().source;
  for (const OdometrySample& sample : main.samples) report.reversing += sample.speed_mps < 0;
  report.odometry = candidates.front().stream;
  for (std::size_t i = 1; i < candidates.size(); ++i) {
    const StreamReport& stream = candidates[i].stream;
    report.odometry.corrupt += stream.corrupt;
    report.notes.push_back(fmt::format("{}: {} samples, usually {:.3g} s apart; nodes come from {}",
                                       candidates[i].source.name, stream.used, stream.median_interval_s,
                                       main.name));
  }
  if (candidates.size() == 1 && description.timeline.gap_policy == GapPolicy::bridge)
    note_gaps(main.gap_s, main.samples.front().stamp, report);
  std::vector<PreparedOdometry> relative;
  for (RelativeCandidate& candidate : candidates) relative.push_back(std::move(candidate.source));
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
