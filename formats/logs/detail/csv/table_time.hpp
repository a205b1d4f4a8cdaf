/// Instants in the forms of tables: counts, dates, days of spreadsheets; private to the CSV reader.
#pragma once

#include <optional>
#include <string_view>

#include <waymark/core/drive/stamp.hpp>

namespace waymark::formats {

/// An instant and the scale that its form names. A count names none.
struct TableInstant {
  Stamp stamp;
  std::optional<TimeScale> scale;
};

/// The unit of times that are times of day.
inline constexpr std::string_view kTimeOfDay = "hms";
/// The unit of a date that is a GPS week.
inline constexpr std::string_view kGpsWeekUnit = "gps_week";

/// Reads a time. @param unit name of one of the units of `time`
/// @param power of ten, of a unit that counts (Unit::factor)
/// @return empty if the field is no such text
[[nodiscard]] std::optional<TableInstant> instant_from_field(std::string_view field, std::string_view unit,
                                                             int power);

/// Reads a date as the instant at its beginning. @param unit name of one of the units of `date`
[[nodiscard]] std::optional<TableInstant> date_from_field(std::string_view field, std::string_view unit);

/// Names what a field of a unit of times or dates must be, for messages: "a decimal number".
[[nodiscard]] std::string_view expected_time(std::string_view unit);

}  // namespace waymark::formats
