/// Dates and times of day as tables and spreadsheets write them.
#pragma once

#include <optional>
#include <string_view>

#include <waymark/core/drive/stamp.hpp>

namespace waymark::formats {

/// The order of year, month and day in a date.
enum class DateOrder { ymd, dmy, mdy };

/// Reads "2024-01-31", "31.1.2024", "1/31/24", "31-Jan-2024" or, without separators, "20240131",
/// "310124". Years of two digits are 1980 to 2079. The order does not matter for a month by name.
/// @return midnight UTC in POSIX nanoseconds; empty if the text is no such date or the date does not exist
[[nodiscard]] std::optional<Stamp> date_from_text(std::string_view text, DateOrder order);

/// Reads "9:05", "09:05:07.25", "9:05:07 PM" or, as NMEA writes it, "090507.25". A zone ("Z", "+01:00") may
/// follow. A decimal comma is understood.
/// @return nanoseconds since midnight UTC, which a zone may make negative; empty for any other text
[[nodiscard]] std::optional<Stamp> time_of_day_from_text(std::string_view text);

/// Reads a date and a time of day that blanks, 'T', '_' or a comma separate.
/// @return POSIX nanoseconds (TimeScale::utc)
[[nodiscard]] std::optional<Stamp> date_time_from_text(std::string_view text, DateOrder order);

}  // namespace waymark::formats
