#include <waymark/tools/inspection/log_clock.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

namespace waymark::inspection {
namespace {

constexpr double kWeek = 604800;
constexpr double kEarliestUnix = 0.9e9;  // 1998

double factor_of(const std::string& unit) {
  if (unit == "ms") return 1e-3;
  if (unit == "us") return 1e-6;
  return unit == "ns" ? 1e-9 : 1;
}

}  // namespace

LogClock clock_of_column(const ColumnSummary* time, const ColumnSummary* date, Stamp now) {
  LogClock clock;
  if (time == nullptr)
    return {TimeScale::unix_time, false, false, false, false, "no column of times is known"};
  const std::string column = fmt::format("column '{}'", time->name);
  const std::string& unit = time->proposal.unit;
  if (unit == "iso8601" || unit == "dmy" || unit == "mdy")
    return {TimeScale::utc, true, true, false, true, column + " holds dates (UTC if they name no zone)"};
  if (unit == "excel" || unit == "matlab" || unit == "filetime")
    return {TimeScale::utc, true, true, false, true, column + " holds dates as numbers (taken as UTC)"};
  if (date != nullptr)
    return {TimeScale::utc,
            true,
            true,
            false,
            true,
            fmt::format("column '{}' holds the dates of {} (UTC if it names no zone)", date->name, column)};
  if (unit == "hms")
    return {TimeScale::utc,
            true,
            true,
            false,
            false,
            column + " holds times of day; the date shown is invented, state 'date' under 'time'"};
  const std::vector<std::string> words = words_of(time->name);
  const auto says = [&](std::string_view word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  const bool of_gps = std::any_of(words.begin(), words.end(),
                                  [](const std::string& word) { return word.starts_with("gps"); });
  const double first = time->range.smallest * factor_of(time->proposal.unit);
  const double last = time->range.largest * factor_of(time->proposal.unit);
  const double gps_now = convert(now, TimeScale::utc, TimeScale::gps).seconds();
  if (says("sow") || says("tow") || says("itow") || says("week"))
    return {TimeScale::gps, false, false, true, true, column + " counts seconds of a GPS week"};
  if (first < 0.3e9 || (first < kEarliestUnix && !of_gps))
    return {TimeScale::unix_time,
            false,
            false,
            false,
            false,
            fmt::format("{} counts from {:.6g}: no date; seconds since an unknown start, or of a week",
                        column, first)};
  if (says("unix") || says("posix") || says("epoch"))
    return {of_gps || says("gnss") ? TimeScale::utc : TimeScale::unix_time,
            false,
            true,
            false,
            true,
            column + " counts Unix seconds" + (of_gps || says("gnss") ? " of a clock steered by GNSS" : "")};
  if (of_gps && last <= gps_now)
    return {TimeScale::gps, false, true, false, true, column + " counts GPS seconds since 1980"};
  if (of_gps)
    return {TimeScale::utc,
            false,
            true,
            false,
            false,
            column +
                " is named GPS, but its numbers are Unix seconds (as GPS seconds they would "
                "be in the future)"};
  if (says("utc"))
    return {TimeScale::utc, false, true, false, true, column + " counts UTC seconds since 1970"};
  return {TimeScale::unix_time, false, true, false, false, column + " holds numbers like Unix seconds"};
}

Stamp on_scale(Stamp stamp, TimeScale from, TimeScale to) {
  constexpr std::int64_t kLargest = 8'000'000'000'000'000'000;
  return convert(Stamp{std::clamp(stamp.nanoseconds, -kLargest, kLargest)}, from, to);
}

WeekSecond week_second(Stamp stamp, const LogClock& clock) {
  const double seconds = on_scale(stamp, clock.scale, TimeScale::gps).seconds();
  const double week = std::floor(seconds / kWeek);
  return {static_cast<int>(week), seconds - week * kWeek};
}

std::string date_text(Stamp stamp, const LogClock& clock) {
  if (!clock.dated) return fmt::format("{:.3f} s", stamp.seconds());
  using namespace std::chrono;
  const std::int64_t ns = on_scale(stamp, clock.scale, TimeScale::utc).nanoseconds;
  const auto instant = sys_time<nanoseconds>(nanoseconds(ns));
  const auto day = floor<days>(instant);
  const year_month_day date(day);
  const auto of_day = duration_cast<milliseconds>(instant - day).count();
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:03}Z", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                     of_day / 3'600'000, of_day / 60'000 % 60, of_day / 1000 % 60, of_day % 1000);
}

}  // namespace waymark::inspection
