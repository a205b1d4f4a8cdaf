/// GPS time as logs write it.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include <waymark/core/drive/stamp.hpp>

namespace waymark::formats {

/// 1980-01-06T00:00:00Z in POSIX nanoseconds: what a date on the GPS scale, which has no leap seconds, counts
/// less than its POSIX count.
inline constexpr std::int64_t kGpsEpochPosix = 315'964'800'000'000'000;

inline constexpr std::int64_t kSecondNanoseconds = 1'000'000'000;
inline constexpr std::int64_t kGpsWeekNanoseconds = 604'800'000'000'000;
/// Weeks since 1980-01-06 that are taken for real: the year 2171.
inline constexpr int kLastGpsWeek = 10'000;

/// Nanoseconds since 1980-01-06 of "2323" and "553950.250", exact. Seconds up to a second beyond the week's
/// end.
/// @return empty where they are no such numbers
[[nodiscard]] std::optional<Stamp> stamp_from_gps_week(std::string_view week, std::string_view seconds);

}  // namespace waymark::formats
