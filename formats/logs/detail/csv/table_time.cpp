#include <waymark/formats/logs/detail/csv/table_time.hpp>

#include <charconv>
#include <cstdint>
#include <string>

#include <fmt/format.h>

#include <waymark/formats/logs/detail/common/gps_time.hpp>
#include <waymark/formats/logs/detail/common/quantity.hpp>
#include <waymark/formats/logs/detail/common/record_fields.hpp>
#include <waymark/formats/text/detail/date_time.hpp>
#include <waymark/formats/text/iso8601.hpp>
#include <waymark/formats/text/stamp_text.hpp>

namespace waymark::formats {
namespace {

/// 1970-01-01 in days since 1899-12-30 (spreadsheets), and as MATLAB's datenum.
constexpr std::int64_t kExcelDay1970 = 25'569;
constexpr std::int64_t kMatlabDay1970 = 719'529;
/// 1970-01-01 in intervals of 100 ns since 1601-01-01.
constexpr std::int64_t kFiletime1970 = 116'444'736'000'000'000;

std::optional<Stamp> counted(std::string_view field, int power) {
  if (power == 0) return stamp_from_decimal_seconds(field);
  if (field.find_first_of("eE") != std::string_view::npos) return std::nullopt;
  return stamp_from_decimal_seconds(fmt::format("{}e{}", field, power));
}

/// Days and their fractions. Four decimals more than a stamp has keep 13 decimals of a day.
std::optional<Stamp> of_days(std::string_view field, std::int64_t day_1970) {
  const std::optional<Stamp> scaled = counted(field, 4);
  if (!scaled || scaled->nanoseconds < 0) return std::nullopt;
  constexpr std::int64_t kScaledDay = 10'000 * kSecondNanoseconds;
  const std::int64_t days = scaled->nanoseconds / kScaledDay;
  const std::int64_t rest = scaled->nanoseconds % kScaledDay;
  std::int64_t whole = 0;  // 64 bits of nanoseconds hold 106,751 days
  if (__builtin_mul_overflow(days - day_1970, 86400 * kSecondNanoseconds, &whole)) return std::nullopt;
  Stamp stamp;
  if (__builtin_add_overflow(whole, (rest * 864 + 50) / 100, &stamp.nanoseconds)) return std::nullopt;
  return stamp;
}

std::optional<Stamp> of_filetime(std::string_view field) {
  std::int64_t count = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), count);
  // 64 bits of nanoseconds hold the years 1678 to 2262.
  constexpr std::int64_t kFirst = 25'000'000'000'000'000;
  constexpr std::int64_t kLast = 200'000'000'000'000'000;
  if (error != std::errc() || end != field.data() + field.size() || count < kFirst || count > kLast)
    return std::nullopt;
  return Stamp{(count - kFiletime1970) * 100};
}

std::optional<DateOrder> order_of(std::string_view unit) {
  if (unit == kIso8601) return DateOrder::ymd;
  if (unit == "dmy") return DateOrder::dmy;
  if (unit == "mdy") return DateOrder::mdy;
  return std::nullopt;
}

std::optional<TableInstant> in_utc(std::optional<Stamp> stamp) {
  if (!stamp) return std::nullopt;
  return TableInstant{*stamp, TimeScale::utc};
}

}  // namespace

std::optional<TableInstant> instant_from_field(std::string_view field, std::string_view unit, int power) {
  if (const std::optional<DateOrder> order = order_of(unit)) {
    if (*order == DateOrder::ymd)
      if (const std::optional<Stamp> stamp = stamp_from_iso8601(field)) return in_utc(stamp);
    return in_utc(date_time_from_text(field, *order));
  }
  if (unit == kTimeOfDay) return in_utc(time_of_day_from_text(field));
  if (unit == "excel") return in_utc(of_days(field, kExcelDay1970));
  if (unit == "matlab") return in_utc(of_days(field, kMatlabDay1970));
  if (unit == "filetime") return in_utc(of_filetime(field));
  const std::optional<Stamp> stamp = counted(field, power);
  if (!stamp) return std::nullopt;
  return TableInstant{*stamp, std::nullopt};
}

std::optional<TableInstant> date_from_field(std::string_view field, std::string_view unit) {
  if (unit == kGpsWeekUnit) {
    const std::optional<int> week = field_count(field);
    if (!week || *week > kLastGpsWeek) return std::nullopt;
    return TableInstant{Stamp{*week * kGpsWeekNanoseconds}, TimeScale::gps};
  }
  if (unit == "excel") return in_utc(of_days(field, kExcelDay1970));
  return in_utc(date_from_text(field, order_of(unit).value_or(DateOrder::ymd)));
}

std::string_view expected_time(std::string_view unit) {
  if (unit == kIso8601) return "an ISO 8601 date";
  if (unit == "dmy") return "a date such as 31.1.2024";
  if (unit == "mdy") return "a date such as 1/31/2024";
  if (unit == kTimeOfDay) return "a time of day such as 09:05:07.25";
  if (unit == kGpsWeekUnit) return "a GPS week";
  if (unit == "filetime") return "a whole number of 100 ns";
  return "a decimal number";
}

}  // namespace waymark::formats
