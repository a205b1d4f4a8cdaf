/// Finds where a table begins in a file. Programs write lines of their own above it: titles, dates, settings.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace waymark::formats {

/// At most this many lines are looked at for the begin of a table.
inline constexpr std::size_t kMostLinesAbove = 100;

/// Where a table begins, as indices of lines.
struct TableStart {
  std::size_t header = 0;     ///< its first line: names, or values if it has no names
  std::size_t first_row = 1;  ///< the first line that may hold values; those between both have none
};

/// Tells whether a field holds a number or a date.
[[nodiscard]] bool holds_value(std::string_view field, char separator);

/// Returns the separator that a line such as "sep=;" states for a spreadsheet.
[[nodiscard]] std::optional<char> stated_separator(std::string_view line);

/// Finds the table. It begins in the first line if that is a row of values, or as wide as a row below it. Otherwise
/// two rows of values of one width tell it: its header is the line of that width above them that holds no values,
/// the first one if several follow each other (units, sources). If there is none, the first line of the file is it.
/// @param lines those with content, without comments, from the first one of the file on
/// @param separator of the fields; 0: that of each line
/// @return empty: more lines are needed, of at most kMostLinesAbove
[[nodiscard]] std::optional<TableStart> table_start(std::span<const std::string> lines, char separator);

}  // namespace waymark::formats
