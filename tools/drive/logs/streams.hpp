/// Steps of preparing any stream of stamped samples: clean, sort, find gaps.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/core/drive/stamp.hpp>
#include <waymark/formats/logs/detail/common/gps_time.hpp>
#include <waymark/formats/text/stamp_text.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>
#include <waymark/tools/drive/logs/time_series.hpp>

namespace waymark::drive {

/// Drops non-finite samples and duplicates, and sorts the rest by stamp (stable).
/// @param is_finite bool(const Sample&)
/// @param same_key bool(const Sample&, const Sample&): adjacent samples of one stamp that
/// exclude each other
/// @param same bool(const Sample&, const Sample&): identical content
template <typename Sample, typename IsFinite, typename SameKey, typename Same>
void clean_stream(std::vector<Sample>& samples, StreamReport& report, IsFinite is_finite, SameKey same_key,
                  Same same) {
  report.read = samples.size();
  std::erase_if(samples, [&](const Sample& sample) { return !is_finite(sample); });
  report.non_finite = report.read - samples.size();
  for (std::size_t i = 1; i < samples.size(); ++i)
    report.out_of_order += samples[i].stamp < samples[i - 1].stamp && same_key(samples[i], samples[i - 1]);
  std::stable_sort(samples.begin(), samples.end(),
                   [](const Sample& a, const Sample& b) { return a.stamp < b.stamp; });

  std::vector<Sample> kept;
  kept.reserve(samples.size());
  for (const Sample& sample : samples) {
    const Sample* earlier = nullptr;  // kept samples with the same stamp are at the end
    for (auto it = kept.rbegin(); it != kept.rend() && it->stamp == sample.stamp; ++it) {
      if (same_key(*it, sample)) earlier = &*it;
    }
    if (earlier == nullptr) {
      kept.push_back(sample);
    } else {
      ++(same(*earlier, sample) ? report.duplicates_identical : report.duplicates_conflicting);
    }
  }
  samples = std::move(kept);
}

/// Says what clean_stream() has dropped or moved. Nothing is counted in silence.
inline void note_cleaning(const char* samples, const StreamReport& stream, PrepareReport& report) {
  const auto note = [&](std::size_t count, const char* what) {
    if (count > 0) report.notes.push_back(fmt::format("{} {} {}", count, samples, what));
  };
  note(stream.non_finite, "have a number that is not finite and are left out");
  note(stream.out_of_order, "are stamped before the one above them; all are sorted");
  note(stream.duplicates_identical, "repeat an earlier one and are left out");
  note(stream.duplicates_conflicting, "contradict an earlier one with the same stamp and are left out");
}

/// Adds the counts and notes of a log's reader.
inline void add_log_report(const LogData& data, StreamReport& stream, PrepareReport& report) {
  stream.records += data.records;
  stream.corrupt += data.corrupt;
  report.notes.insert(report.notes.end(), data.notes.begin(), data.notes.end());
  report.corrupt_examples.insert(report.corrupt_examples.end(), data.corrupt_examples.begin(),
                                 data.corrupt_examples.end());
}

/// Lets seconds of the day go on behind midnight, where all stamps of a log are less than a day and fall by nearly that.
/// @param samples in the order of the log @param stamp_of Stamp&(Sample&)
template <typename Samples, typename StampOf>
void pass_midnights(Samples& samples, StampOf stamp_of) {
  constexpr std::int64_t kDay = 86'400'000'000'000;
  constexpr std::int64_t kLongestGap = kDay / 24;
  const bool are_of_day = std::all_of(samples.begin(), samples.end(), [&](auto& sample) {
    const std::int64_t time = stamp_of(sample).nanoseconds;
    return time >= 0 && time < kDay;
  });
  if (!are_of_day) return;
  std::int64_t last = 0;
  std::int64_t midnights = 0;
  for (auto& sample : samples) {
    Stamp& stamp = stamp_of(sample);
    midnights += last - stamp.nanoseconds > kDay - kLongestGap;
    last = stamp.nanoseconds;
    stamp.nanoseconds += midnights * kDay;
  }
}

/// Converts the stamps of a log to the scale of the drive; those that are seconds of the day pass midnight.
/// @param samples in the order of the log @param stamp_of Stamp&(Sample&)
/// @throws InputError for seconds of week that would need a date
template <typename Samples, typename StampOf>
void put_on_scale(Samples&& samples, const DriveLogs::Log& log, TimeScale scale, StampOf stamp_of) {
  constexpr std::int64_t kTwoWeeks = 2 * formats::kGpsWeekNanoseconds;
  const bool changes_scale = convert(Stamp{}, log.scale, scale) != Stamp{};
  pass_midnights(samples, stamp_of);
  for (auto& sample : samples) {
    Stamp& stamp = stamp_of(sample);
    if (changes_scale && log.scale == TimeScale::gps && stamp.nanoseconds < kTwoWeeks)
      throw InputError(log.file + ": seconds of week cannot be put onto the scale '" +
                       std::string(to_string(scale)) + "' of the drive; state the log's 'time: {week: ...}'");
    stamp = convert(stamp, log.scale, scale);
  }
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

/// Fills used, median_interval_s and gaps.
/// @param gap_s longer intervals are gaps; 0: 2.5 median intervals
template <typename Sample>
void describe_stream(const std::vector<Sample>& samples, double gap_s, StreamReport& report) {
  report.used = samples.size();
  std::vector<double> intervals;
  for (std::size_t i = 1; i < samples.size(); ++i)
    intervals.push_back(seconds_between(samples[i - 1].stamp, samples[i].stamp));
  if (intervals.empty()) return;
  report.median_interval_s = upper_median(intervals);
  const double limit = gap_s > 0 ? gap_s : 2.5 * report.median_interval_s;
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    if (intervals[i] > limit) report.gaps.push_back({samples[i].stamp, intervals[i]});
  }
}

/// Returns "from 12.5 s to 80.25 s".
template <typename Sample>
std::string span_text(const std::vector<Sample>& samples) {
  return fmt::format("from {} s to {} s", formats::decimal_seconds(samples.front().stamp),
                     formats::decimal_seconds(samples.back().stamp));
}

/// Tells whether two samples are at the same geodetic place; unknown heights are equal.
bool same_place(const auto& a, const auto& b) {
  const bool unknown = std::isnan(a.height_m) && std::isnan(b.height_m);
  return a.latitude_deg == b.latitude_deg && a.longitude_deg == b.longitude_deg &&
         (a.height_m == b.height_m || unknown);
}

bool finite_place(const auto& sample) {
  return std::isfinite(sample.latitude_deg) && std::isfinite(sample.longitude_deg);
}

/// Returns seconds as whole nanoseconds, rounded.
inline std::int64_t nanoseconds(double seconds) {
  return std::llround(seconds * 1e9);
}

}  // namespace waymark::drive
