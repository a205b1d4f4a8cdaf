#include <waymark/formats/logs/detail/ubx/ubx_time.hpp>

#include <cstdlib>

#include <waymark/formats/logs/detail/common/gps_time.hpp>

namespace waymark::formats {
namespace {

constexpr std::int64_t kWeek = kGpsWeekNanoseconds;

std::int64_t of_week(std::uint32_t itow_ms) {
  return std::int64_t{itow_ms} * 1'000'000;
}

/// Returns the quotient rounded to the nearest integer. `by` is positive.
std::int64_t rounded_quotient(std::int64_t value, std::int64_t by) {
  const std::int64_t half = value >= 0 ? by / 2 : -by / 2;
  return (value + half) / by;
}

}  // namespace

std::int64_t UbxTime::nearest(std::int64_t to, std::uint32_t itow_ms) const {
  return of_week(itow_ms) + kWeek * rounded_quotient(to - of_week(itow_ms), kWeek);
}

std::int64_t UbxTime::from_date(const UbxDate& date, std::uint32_t itow_ms) {
  std::int64_t gps = convert(date.utc, TimeScale::utc, TimeScale::gps).nanoseconds;
  if (date.leap_second) gps += kSecondNanoseconds;
  const std::int64_t seconds = rounded_quotient(gps - nearest(gps, itow_ms), kSecondNanoseconds);
  if (seconds != 0 && !date.resolved && std::abs(seconds) <= 60) {
    ++seconds_from_itow_;
    gps -= seconds * kSecondNanoseconds;
  } else if (seconds != 0) {
    ++disagreements_;
  }
  last_ = gps;
  return gps;
}

std::int64_t UbxTime::from_week(const UbxWeek& week, std::uint32_t itow_ms) {
  last_ = kWeek * week.week + of_week(itow_ms) + week.fraction_ns;
  return *last_;
}

std::optional<std::int64_t> UbxTime::from_itow(std::uint32_t itow_ms) {
  if (!last_ && stated_week_ == 0) return std::nullopt;
  const std::int64_t gps = last_ ? nearest(*last_, itow_ms) : kWeek * stated_week_ + of_week(itow_ms);
  // damaged data has led here, week by week
  if (gps < 0 || gps > kWeek * kLastGpsWeek) return std::nullopt;
  used_stated_week_ = used_stated_week_ || !last_;
  ++continued_;
  last_ = gps;
  return last_;
}

}  // namespace waymark::formats
