/// Dates with time of day in the form that gpsd and many loggers write.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <waymark/core/drive/stamp.hpp>

namespace waymark::formats {

/// Reads "2023-06-28T14:52:12.250Z": the extended form of ISO 8601. The seconds may have any number
/// of decimals and are rounded to the nanosecond. 'T' or one blank separates date and time. The
/// zone is "Z", "+hh:mm", "-hhmm", "+hh" or none (read as UTC). A leap second 23:59:60 counts as
/// the second after it, as in POSIX time.
/// @return POSIX nanoseconds (TimeScale::utc); empty if the text is no such date or the date does
/// not exist (June 31)
[[nodiscard]] std::optional<Stamp> stamp_from_iso8601(std::string_view text);

/// The inverse of stamp_from_iso8601: "2023-06-28T14:52:12.25Z" with as many decimals as needed,
/// and none for whole seconds. @param utc POSIX nanoseconds
[[nodiscard]] std::string iso8601_from_stamp(Stamp utc);

}  // namespace waymark::formats
