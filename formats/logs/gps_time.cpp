#include <waymark/formats/logs/gps_time.hpp>

#include <cstdint>

#include <waymark/formats/logs/record_fields.hpp>
#include <waymark/formats/stamp_text.hpp>

namespace waymark {
namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
constexpr std::int64_t kWeek = 604'800 * kNanosecondsPerSecond;

}  // namespace

std::optional<Stamp> stamp_from_gps_week(std::string_view week, std::string_view seconds) {
  const std::optional<int> weeks = field_count(week);
  // A longer text allocates, and is no time.
  if (!weeks || *weeks > 9999 || seconds.size() > 20) return std::nullopt;
  const std::optional<Stamp> of_week = stamp_from_decimal_seconds(seconds);
  if (!of_week || of_week->nanoseconds < 0 || of_week->nanoseconds > kWeek + kNanosecondsPerSecond)
    return std::nullopt;
  return Stamp{*weeks * kWeek + of_week->nanoseconds};
}

}  // namespace waymark
