/// Time stamps: int64 nanoseconds on a named scale. A stamp without a scale has no meaning.
#pragma once

#include <cmath>
#include <compare>
#include <cstdint>
#include <optional>
#include <string_view>

#include <waymark/core/base/export.hpp>

namespace WAYMARK_EXPORT waymark {

/// The scale of a stamp. `gps` counts seconds since 1980-01-06T00:00:00 without leap seconds;
/// logs with seconds of week count from the start of the week. `utc` and `unix_time` count POSIX
/// seconds since 1970-01-01T00:00:00 UTC. `utc` is a clock steered by GNSS, `unix_time` the
/// clock of a host.
enum class TimeScale { gps, utc, unix_time };

/// Returns "gps", "utc" or "unix".
[[nodiscard]] std::string_view to_string(TimeScale scale);
/// The inverse of to_string. Empty for any other word.
[[nodiscard]] std::optional<TimeScale> time_scale_from_string(std::string_view word);

/// An instant: nanoseconds on the scale that the container names.
struct Stamp {
  std::int64_t nanoseconds = 0;

  friend constexpr auto operator<=>(Stamp, Stamp) = default;

  /// Converts seconds, rounded to the nearest nanosecond. @param seconds |seconds| < 9.2e9
  [[nodiscard]] static Stamp from_seconds(double seconds) {
    const double whole = std::floor(seconds);
    return Stamp{static_cast<std::int64_t>(whole) * 1'000'000'000 + std::llround((seconds - whole) * 1e9)};
  }
  /// Returns the instant that is `seconds` later, to the nanosecond. @param seconds |seconds| < 9.2e9
  [[nodiscard]] Stamp later(double seconds) const { return Stamp{nanoseconds + std::llround(seconds * 1e9)}; }
  [[nodiscard]] constexpr double seconds() const { return static_cast<double>(nanoseconds) * 1e-9; }
};

/// Returns the signed time from `earlier` to `later` in seconds. It is exact to a nanosecond before
/// the only rounding.
[[nodiscard]] constexpr double seconds_between(Stamp earlier, Stamp later) {
  return static_cast<double>(later.nanoseconds - earlier.nanoseconds) * 1e-9;
}

/// Returns the same instant on another scale. GPS <-> UTC uses the table of leap seconds up to
/// 2017-01-01 (18 s). `utc` and `unix_time` count alike. Both scales must carry complete dates (not
/// seconds of week).
[[nodiscard]] Stamp convert(Stamp stamp, TimeScale from, TimeScale to);

}  // namespace waymark
