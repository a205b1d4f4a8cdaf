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

LogClock clock_of_column(const ColumnSummary* time, Stamp now) {
  LogClock clock;
  if (time == nullptr)
    return {TimeScale::unix_time, false, false, false, false, "no column of times is known"};
  const std::string column = fmt::format("column '{}'", time->name);
  if (time->proposal.unit == "iso8601")
    return {TimeScale::utc, true, true, false, true, column + " holds dates (UTC if they name no zone)"};
  const std::vector<std::string> words = words_of(time->name);
  const auto says = [&](std::string_view word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  const double first = time->range.smallest * factor_of(time->proposal.unit);
  const double last = time->range.largest * factor_of(time->proposal.unit);
  const double gps_now = convert(now, TimeScale::utc, TimeScale::gps).seconds();
  if (says("sow") || says("tow") || says("itow") || says("week"))
    return {TimeScale::gps, false, false, true, true, column + " counts seconds of a GPS week"};
  if (first < 0.3e9 || (first < kEarliestUnix && !says("gps")))
    return {TimeScale::unix_time,
            false,
            false,
            false,
            false,
            fmt::format("{} counts from {:.6g}: no date; seconds since an unknown start, or of a week",
                        column, first)};
  if (says("unix") || says("posix") || says("epoch"))
    return {
        says("gps") || says("gnss") ? TimeScale::utc : TimeScale::unix_time,
        false,
        true,
        false,
        true,
        column + " counts Unix seconds" + (says("gps") || says("gnss") ? " of a clock steered by GNSS" : "")};
  if (says("gps") && last <= gps_now)
    return {TimeScale::gps, false, true, false, true, column + " counts GPS seconds since 1980"};
  if (says("gps"))
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
