#include <waymark/formats/logs/detail/csv/table_header.hpp>

#include <algorithm>
#include <cmath>

#include <waymark/core/base/suggest.hpp>
#include <waymark/formats/logs/detail/common/unit_words.hpp>
#include <waymark/formats/logs/detail/csv/csv_columns.hpp>
#include <waymark/formats/text/detail/characters.hpp>

namespace waymark::formats {
namespace {

constexpr std::string_view kRosPrefix = "field.";

/// Returns the place of the bracket that opens the end of a name; npos: it ends in none.
std::size_t end_in_brackets(std::string_view name) {
  if (name.ends_with(']')) return name.rfind('[');
  return name.ends_with(')') ? name.rfind('(') : std::string_view::npos;
}

}  // namespace

bool is_unit_row(std::span<const std::string_view> fields, char separator) {
  std::size_t units = 0;
  for (const std::string_view field : fields) {
    if (!unit_in_row(field).empty()) {
      ++units;
    } else if (const std::optional<double> number = number_from_field(field, separator)) {
      if (!std::isnan(*number) && field != "1") return false;
    } else if (std::any_of(field.begin(), field.end(), is_digit)) {
      return false;
    }
  }
  return units > 0;
}

std::string_view unit_in_row(std::string_view field) {
  const std::string_view unit = unit_in_name(field);
  return unit.empty() ? known_unit(field) : unit;
}

std::string_view unit_in_name(std::string_view name) {
  const std::size_t open = end_in_brackets(name);
  if (open == std::string_view::npos) return {};
  return known_unit(without_blanks(name.substr(open + 1, name.size() - open - 2)));
}

std::string plain_name(std::string_view name) {
  if (name.starts_with(kRosPrefix)) name.remove_prefix(kRosPrefix.size());
  if (!unit_in_name(name).empty()) name = without_blanks(name.substr(0, end_in_brackets(name)));
  return lower_case(name);
}

}  // namespace waymark::formats
