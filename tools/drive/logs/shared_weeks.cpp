#include <waymark/tools/drive/logs/shared_weeks.hpp>

#include <cmath>
#include <cstdint>
#include <optional>

#include <fmt/format.h>

#include <waymark/formats/logs/detail/common/gps_time.hpp>

namespace waymark::drive {
namespace {

using formats::kGpsWeekNanoseconds;

/// Calls a function with every stamp.
template <typename Take>
void each_stamp(LogData& data, Take take) {
  for (OdometrySample& sample : data.odometry) take(sample.stamp);
  for (GeodeticFix& fix : data.fixes) take(fix.stamp);
  for (GeodeticTruth& truth : data.truth) take(truth.stamp);
  for (Stamp& stamp : data.readings.stamps) take(stamp);
  for (ClockPair& pair : data.clocks) {
    take(pair.logged);
    take(pair.told);
  }
}

/// Returns the time of the week at which a log begins; empty: it tells dates, or nothing.
std::optional<std::int64_t> begin_of_week_time(const ReadLog& read) {
  const LogRequest& request = read.config->request;
  std::optional<Stamp> first;
  each_stamp(read.log->data, [&](Stamp stamp) {
    if (!first) first = stamp;
  });
  if (!first || read.log->scale != TimeScale::gps || request.date) return std::nullopt;
  const std::int64_t begin =
      first->nanoseconds - request.gps_week * kGpsWeekNanoseconds - std::llround(request.time_offset_s * 1e9);
  const bool is_of_week = begin >= 0 && begin <= kGpsWeekNanoseconds + formats::kSecondNanoseconds;
  return is_of_week ? std::optional(begin) : std::nullopt;
}

/// Returns the time between the first and the last stamp, ns.
std::int64_t duration(const ReadLog& read) {
  std::optional<Stamp> first;
  Stamp last;
  each_stamp(read.log->data, [&](Stamp stamp) {
    if (!first) first = stamp;
    last = std::max(last, stamp);
  });
  return first ? last.nanoseconds - first->nanoseconds : 0;
}

}  // namespace

void share_weeks(std::span<const ReadLog> logs) {
  std::optional<std::int64_t> latest;
  const ReadLog* late = nullptr;
  for (const ReadLog& read : logs) {
    const auto begin = begin_of_week_time(read);
    if (!begin || (latest && *begin <= *latest)) continue;
    latest = begin;
    late = &read;
  }
  if (!latest) return;
  for (const ReadLog& read : logs) {
    if (read.config->request.gps_week != late->config->request.gps_week) continue;
    const auto begin = begin_of_week_time(read);
    if (!begin || *latest - *begin <= kGpsWeekNanoseconds / 2) continue;
    if (*begin + duration(read) > *latest) continue;  // it overlaps the late one as it is
    each_stamp(read.log->data, [](Stamp& stamp) { stamp.nanoseconds += kGpsWeekNanoseconds; });
    read.log->data.notes.push_back(fmt::format(
        "{}: its times of the week begin after the end of the week in which {} begins; a week is added to "
        "them",
        read.log->file, late->log->file));
  }
}

}  // namespace waymark::drive
