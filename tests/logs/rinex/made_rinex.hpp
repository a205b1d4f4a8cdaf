/// RINEX files made by hand: a satellite of GPS above the equator, at the begin of GPS week 1900 (Sunday, 2016-06-05).
#pragma once

#include <string>
#include <string_view>

namespace waymark_test {

/// A header line: its content, and its label from column 61 on.
[[nodiscard]] std::string rinex_header_line(std::string content, std::string_view label);

/// The header of RINEX 3.03 observations with C1C L1C D1C S1C of GPS, by a receiver at latitude 0, longitude 0.
[[nodiscard]] std::string made_rinex_header();

/// Such a file with one epoch a second from the begin of the week on. Each has G05 alone, in the zenith.
[[nodiscard]] std::string made_rinex_observations(int epochs);

/// RINEX 3.03 navigation with G05: a circular orbit in the plane of the equator, at longitude 0 when the week begins.
[[nodiscard]] std::string made_rinex_navigation();

}  // namespace waymark_test
