/// Dates with time of day, as gpsd and many loggers write them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <waymark/core/drive/stamp.hpp>

namespace waymark::formats {

/// "2023-06-28T14:52:12.250Z": ISO 8601 extended form, seconds with any number of decimals (rounded to the
/// nanosecond), 'T' or one blank between date and time, zone "Z", "+hh:mm", "-hhmm", "+hh" or none (read as
/// UTC). A leap second 23:59:60 counts as the second after it, as POSIX time does.
/// @return POSIX nanoseconds (TimeScale::utc); empty where the text is no such date or does not exist (June
/// 31).
[[nodiscard]] std::optional<Stamp> stamp_from_iso8601(std::string_view text);

/// Inverse of stamp_from_iso8601: "2023-06-28T14:52:12.25Z", with as many decimals as it needs, none for
/// whole seconds. @param utc  POSIX nanoseconds
[[nodiscard]] std::string iso8601_from_stamp(Stamp utc);

}  // namespace waymark::formats
