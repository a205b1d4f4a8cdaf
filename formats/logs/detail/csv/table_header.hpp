/// Names and units in the header of a table; private to the CSV reader and the inspection.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace waymark::formats {

/// Tells whether a line below the header names units: it has no numbers and at least one known unit.
[[nodiscard]] bool is_unit_row(std::span<const std::string_view> fields, char separator);

/// Returns the known unit that a field of a row of units, or the end of a name in brackets, names: "km/h" for
/// "[kph]" and "Speed (kph)". Empty if there is none.
[[nodiscard]] std::string_view unit_in_row(std::string_view field);
[[nodiscard]] std::string_view unit_in_name(std::string_view name);

/// Returns a name in small letters without the unit in brackets at its end and without "field." at its
/// beginning (rostopic): "latitude" for "field.latitude" and "Latitude [deg]".
[[nodiscard]] std::string plain_name(std::string_view name);

}  // namespace waymark::formats
