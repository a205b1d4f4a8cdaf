#include <array>

#include <waymark/core/drive/stamp.hpp>

namespace waymark {
namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
constexpr std::int64_t kGpsEpochUnixSeconds = 315'964'800;  // 1980-01-06T00:00:00Z

// UTC instants (POSIX seconds) at which GPS - UTC grows by one second (IERS Bulletin C).
constexpr std::array<std::int64_t, 18> kLeapInstants = {
    362793600, 394329600, 425865600, 489024000, 567993600,  631152000,  662688000,  709948800,  741484800,
    773020800, 820454400, 867715200, 915148800, 1136073600, 1230768000, 1341100800, 1435708800, 1483228800};

std::int64_t leap_seconds_at_utc(std::int64_t unix_nanoseconds) {
  std::int64_t count = 0;
  for (const std::int64_t instant : kLeapInstants)
    count += unix_nanoseconds >= instant * kNanosecondsPerSecond;
  return count;
}

std::int64_t gps_from_utc(std::int64_t unix_nanoseconds) {
  return unix_nanoseconds +
         (leap_seconds_at_utc(unix_nanoseconds) - kGpsEpochUnixSeconds) * kNanosecondsPerSecond;
}

std::int64_t utc_from_gps(std::int64_t gps_nanoseconds) {
  const std::int64_t without_leap = gps_nanoseconds + kGpsEpochUnixSeconds * kNanosecondsPerSecond;
  // The number of leap seconds must be that at the result, which is at most 18 s earlier.
  std::int64_t leap = leap_seconds_at_utc(without_leap);
  leap = leap_seconds_at_utc(without_leap - leap * kNanosecondsPerSecond);
  return without_leap - leap * kNanosecondsPerSecond;
}

}  // namespace

std::string_view to_string(TimeScale scale) {
  switch (scale) {
    case TimeScale::gps:
      return "gps";
    case TimeScale::utc:
      return "utc";
    case TimeScale::unix_time:
      return "unix";
  }
  return "gps";
}

std::optional<TimeScale> time_scale_from_string(std::string_view word) {
  for (const TimeScale scale : {TimeScale::gps, TimeScale::utc, TimeScale::unix_time}) {
    if (word == to_string(scale)) return scale;
  }
  return std::nullopt;
}

Stamp convert(Stamp stamp, TimeScale from, TimeScale to) {
  const bool from_gps = from == TimeScale::gps;
  const bool to_gps = to == TimeScale::gps;
  if (from_gps == to_gps) return stamp;
  return Stamp{from_gps ? utc_from_gps(stamp.nanoseconds) : gps_from_utc(stamp.nanoseconds)};
}

}  // namespace waymark
