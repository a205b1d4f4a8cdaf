/// GPS time in the forms that logs use.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include <waymark/core/drive/stamp.hpp>

namespace waymark::formats {

/// 1980-01-06T00:00:00Z in POSIX nanoseconds. The GPS scale has no leap seconds: a date on it
/// counts this much less than the same date in POSIX time.
inline constexpr std::int64_t kGpsEpochPosix = 315'964'800'000'000'000;

inline constexpr std::int64_t kSecondNanoseconds = 1'000'000'000;
inline constexpr std::int64_t kDayNanoseconds = 86'400'000'000'000;
inline constexpr std::int64_t kGpsWeekNanoseconds = 604'800'000'000'000;
/// Weeks since 1980-01-06 that are taken for real: the year 2171.
inline constexpr int kLastGpsWeek = 10'000;

/// Returns nanoseconds since 1980-01-06 for texts like "2323" and "553950.250", exactly. The
/// seconds may exceed the week by up to one second.
/// @return empty if the texts are no such numbers
[[nodiscard]] std::optional<Stamp> stamp_from_gps_week(std::string_view week, std::string_view seconds);

/// Returns the time with these seconds of the week that is nearest to `near`, both on one scale without leap seconds.
[[nodiscard]] Stamp in_nearest_week(Stamp near, double seconds_of_week);

/// Follows a count of the time of the week over the end of the week. Times outside of one week, as those of dates,
/// pass unchanged.
class WeekCount {
 public:
  /// Returns the time since the beginning of the first time's week. Each fall by more than half a week begins the next
  /// one, and a rise by as much takes that back: rows around the end of a week may be in disorder.
  [[nodiscard]] Stamp continued(Stamp time_of_week);

 private:
  Stamp last_{};
  std::int64_t weeks_ = 0;
};

}  // namespace waymark::formats
