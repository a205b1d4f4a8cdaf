#include <waymark/tools/drive/logs/shared_weeks.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

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

/// The times of the week between which a log lies, ns.
struct WeekTimes {
  std::int64_t begin = 0;
  std::int64_t end = 0;  ///< beyond a week if its reader went over the end of one
};

/// Returns those of a log; empty: it tells dates, or nothing.
std::optional<WeekTimes> week_times_of(const ReadLog& read) {
  const LogRequest& request = read.config->request;
  if (read.log->scale != TimeScale::gps || request.date) return std::nullopt;
  std::optional<Stamp> first;
  Stamp last;
  each_stamp(read.log->data, [&](Stamp stamp) {
    if (!first) first = last = stamp;
    last = std::max(last, stamp);
  });
  if (!first) return std::nullopt;
  const std::int64_t begin_of_week =
      request.gps_week * kGpsWeekNanoseconds + std::llround(request.time_offset_s * 1e9);
  const WeekTimes times{first->nanoseconds - begin_of_week, last.nanoseconds - begin_of_week};
  const bool is_of_week =
      times.begin >= 0 && times.begin <= kGpsWeekNanoseconds + formats::kSecondNanoseconds;
  return is_of_week ? std::optional(times) : std::nullopt;
}

/// Tells whether a log seems to lie before another one because a week ended in between.
bool is_of_next_week(const WeekTimes& times, const WeekTimes& late) {
  return late.begin - times.begin > kGpsWeekNanoseconds / 2 && times.end <= late.begin;
}

}  // namespace

void share_weeks(std::span<const ReadLog> logs) {
  std::vector<std::optional<WeekTimes>> times;
  std::optional<std::size_t> late;
  for (const ReadLog& read : logs) {
    times.push_back(week_times_of(read));
    if (times.back() && (!late || times.back()->begin > times[*late]->begin)) late = times.size() - 1;
  }
  if (!late) return;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    const ReadLog& read = logs[i];
    if (read.config->request.gps_week != logs[*late].config->request.gps_week) continue;
    if (!times[i] || !is_of_next_week(*times[i], *times[*late])) continue;
    each_stamp(read.log->data, [](Stamp& stamp) { stamp.nanoseconds += kGpsWeekNanoseconds; });
    read.log->data.notes.push_back(fmt::format(
        "{}: its times of the week begin after the end of the week in which {} begins; a week is added to "
        "them",
        read.log->file, logs[*late].log->file));
  }
}

}  // namespace waymark::drive
