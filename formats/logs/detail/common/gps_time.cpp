#include <waymark/formats/logs/detail/common/gps_time.hpp>

#include <cstdint>

#include <waymark/formats/logs/detail/common/record_fields.hpp>
#include <waymark/formats/text/stamp_text.hpp>

namespace waymark::formats {

std::optional<Stamp> stamp_from_gps_week(std::string_view week, std::string_view seconds) {
  const std::optional<int> weeks = field_count(week);
  // A longer text would allocate, and is no time.
  if (!weeks || *weeks > 9999 || seconds.size() > 20) return std::nullopt;
  const std::optional<Stamp> of_week = stamp_from_decimal_seconds(seconds);
  if (!of_week || of_week->nanoseconds < 0 || of_week->nanoseconds > kGpsWeekNanoseconds + kSecondNanoseconds)
    return std::nullopt;
  return Stamp{*weeks * kGpsWeekNanoseconds + of_week->nanoseconds};
}

Stamp in_nearest_week(Stamp near, double seconds_of_week) {
  const std::int64_t begin = near.nanoseconds / kGpsWeekNanoseconds * kGpsWeekNanoseconds;
  Stamp time = Stamp{begin}.later(seconds_of_week);
  const std::int64_t ahead = time.nanoseconds - near.nanoseconds;
  if (ahead > kGpsWeekNanoseconds / 2) time.nanoseconds -= kGpsWeekNanoseconds;
  if (ahead < -kGpsWeekNanoseconds / 2) time.nanoseconds += kGpsWeekNanoseconds;
  return time;
}

Stamp WeekCount::continued(Stamp time_of_week) {
  const std::int64_t time = time_of_week.nanoseconds;
  if (time < 0 || time > kGpsWeekNanoseconds + kSecondNanoseconds) return time_of_week;
  const std::int64_t fall = last_.nanoseconds - time;
  if (fall > kGpsWeekNanoseconds / 2) ++weeks_;
  if (-fall > kGpsWeekNanoseconds / 2 && weeks_ > 0) --weeks_;
  last_ = time_of_week;
  return Stamp{time + weeks_ * kGpsWeekNanoseconds};
}

}  // namespace waymark::formats
