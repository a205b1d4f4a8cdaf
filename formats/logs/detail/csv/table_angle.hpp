/// Latitudes and longitudes as texts: degrees and minutes, letters of a hemisphere; private to the CSV reader.
#pragma once

#include <optional>
#include <string_view>

namespace waymark::formats {

/// The units of an angle that is not one number of degrees.
inline constexpr std::string_view kDegreesMinutes = "ddmm";
inline constexpr std::string_view kDegreesMinutesSeconds = "dms";

/// Reads a latitude or longitude. In every unit a letter of a hemisphere may stand before or after it.
/// @param unit "ddmm": "4807.038" is 48 degrees and 7.038 minutes; "dms": 48°7'2.3", 48 7 2.3, 48:7:2.3, the
/// seconds or the minutes may lack; any other: one number, also with a degree sign
/// @return the number in its unit ("ddmm", "dms": degrees), negative in the south and west; empty for any
/// other text, for minutes and seconds of 60 and more, and for a sign beside a letter
[[nodiscard]] std::optional<double> angle_from_field(std::string_view field, std::string_view unit);

/// Returns -1 for "S" or "W", 1 for "N" or "E" (also in small letters and as words). Empty for any other text.
[[nodiscard]] std::optional<double> hemisphere_from_field(std::string_view field);

}  // namespace waymark::formats
