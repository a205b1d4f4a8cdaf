/// The columns of RINEX lines, and what observation and navigation files have in common.
#pragma once

#include <optional>
#include <string_view>

#include <waymark/core/drive/stamp.hpp>
#include <waymark/formats/satellites/ephemerides.hpp>

namespace waymark::formats {

/// Returns columns of a line without blanks around them. A short line ends with blanks.
/// @param begin 0-based
[[nodiscard]] std::string_view rinex_field(std::string_view line, std::size_t begin, std::size_t width);
/// Returns the label of a header line, which begins in column 61.
[[nodiscard]] std::string_view rinex_label(std::string_view line);
/// Reads a number; D is an exponent too, as Fortran writes it. Empty: no number.
[[nodiscard]] std::optional<double> rinex_number(std::string_view line, std::size_t begin, std::size_t width);
[[nodiscard]] std::optional<int> rinex_count(std::string_view line, std::size_t begin, std::size_t width);

/// Year (two digits are 1980 to 2079), month, day, hour, minute and seconds.
struct RinexDate {
  int year = 0, month = 0, day = 0, hour = 0, minute = 0;
  double second = 0;
};
/// Returns nanoseconds since the epoch of GPS as the calendar counts them, without leap seconds. Empty for
/// a date that does not exist and before 1980.
[[nodiscard]] std::optional<Stamp> stamp_of(const RinexDate& date);

/// Reads "G05", "R 4", " 12" (of `blank`'s system).
/// @returns nothing for letters of systems that are not known, and impossible numbers
[[nodiscard]] std::optional<satellites::SatelliteName> rinex_satellite(std::string_view field, char blank);

/// Version, and kind of file: 'O' observations, 'N' navigation, ...
struct RinexVersion {
  double version = 0;
  char kind = ' ';
  char system = ' ';  ///< 'M': mixed; ' ': GPS
};
/// Reads the first line of a RINEX file. Empty if it is none.
[[nodiscard]] std::optional<RinexVersion> rinex_version(std::string_view line);

}  // namespace waymark::formats
