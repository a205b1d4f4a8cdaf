#include <waymark/formats/logs/detail/csv/table_start.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <waymark/core/base/suggest.hpp>
#include <waymark/formats/logs/detail/common/quantity.hpp>
#include <waymark/formats/logs/detail/csv/csv_columns.hpp>
#include <waymark/formats/logs/detail/csv/csv_table.hpp>
#include <waymark/formats/logs/detail/csv/table_time.hpp>
#include <waymark/formats/text/detail/characters.hpp>

namespace waymark::formats {
namespace {

/// How a line looks as a line of a table.
struct LineShape {
  std::size_t width = 0;      ///< fields
  bool ends_empty = false;    ///< behind a trailing separator, or without a last value
  bool has_value = false;     ///< at least one
  bool holds_values = false;  ///< more than half of the filled ones

  [[nodiscard]] bool is_as_wide_as(const LineShape& other) const {
    return width == other.width || (ends_empty && width == other.width + 1) ||
           (other.ends_empty && width + 1 == other.width);
  }
};

LineShape shape_of(std::string_view line, char separator) {
  const char own = separator != 0 ? separator : separator_of(line);
  std::vector<std::string_view> fields;
  if (!split_fields(line, own, fields)) return {};
  std::ptrdiff_t filled = 0;
  std::ptrdiff_t values = 0;
  for (const std::string_view field : fields) {
    const std::optional<double> number = number_from_field(field, own);
    filled += !number || !std::isnan(*number);
    values += holds_value(field, own);
  }
  return {fields.size(), fields.back().empty(), values > 0, 2 * values > filled};
}

}  // namespace

bool holds_value(std::string_view field, char separator) {
  if (const std::optional<double> number = number_from_field(field, separator)) return !std::isnan(*number);
  return instant_from_field(field, kIso8601, 0) || instant_from_field(field, "dmy", 0) ||
         instant_from_field(field, "mdy", 0);
}

std::optional<char> stated_separator(std::string_view line) {
  std::string text = lower_case(without_blanks(line));
  std::erase(text, '"');
  if (text.size() != 5 || !text.starts_with("sep=")) return std::nullopt;
  return text.back();
}

std::optional<TableStart> table_start(std::span<const std::string> lines, char separator) {
  if (lines.size() < 2) return std::nullopt;
  const LineShape first = shape_of(lines[0], separator);
  const LineShape second = shape_of(lines[1], separator);
  // Lines of two words may be settings above the table: "Driver,Ann".
  const bool second_is_row = second.width > 2 ? second.has_value : second.holds_values;
  if (first.holds_values || (first.is_as_wide_as(second) && second_is_row)) return TableStart{};
  const std::size_t last = lines.size() - 1;
  const LineShape row = shape_of(lines[last], separator);
  const LineShape above = shape_of(lines[last - 1], separator);
  if (!row.holds_values || row.width < 2 || !above.holds_values || !above.is_as_wide_as(row))
    return std::nullopt;
  const auto is_header = [&](std::size_t i) {
    const LineShape shape = shape_of(lines[i], separator);
    return !shape.holds_values && shape.is_as_wide_as(row);
  };
  std::size_t below = last - 1;
  while (below > 0 && !is_header(below - 1)) --below;
  if (below == 0) return TableStart{};
  std::size_t header = below - 1;
  while (header > 0 && is_header(header - 1)) --header;
  std::size_t first_row = header + 1;
  while (first_row < below && !shape_of(lines[first_row], separator).has_value) ++first_row;
  return TableStart{header, first_row};
}

}  // namespace waymark::formats
