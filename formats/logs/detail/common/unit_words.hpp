/// Units as the headers of tables and the signals of DBC files write them.
#pragma once

#include <string_view>

namespace waymark::formats {

/// Returns this library's name for a unit: "km/h" for "kph" or "KM/H", "deg" for a degree sign. Empty for an
/// unknown unit.
[[nodiscard]] std::string_view known_unit(std::string_view word);

}  // namespace waymark::formats
