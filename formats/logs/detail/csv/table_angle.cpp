#include <waymark/formats/logs/detail/csv/table_angle.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <waymark/core/base/suggest.hpp>
#include <waymark/formats/logs/detail/common/record_fields.hpp>
#include <waymark/formats/text/detail/characters.hpp>

namespace waymark::formats {
namespace {

constexpr std::string_view kDegreeSign = "\xC2\xB0";

/// Takes the letter of a hemisphere off either end. @return its sign; 0: there is none
double take_letter(std::string_view& text) {
  if (text.empty()) return 0;
  if (const auto sign = hemisphere_from_field(text.substr(0, 1))) {
    text = without_blanks(text.substr(1));
    return *sign;
  }
  if (const auto sign = hemisphere_from_field(text.substr(text.size() - 1))) {
    text = without_blanks(text.substr(0, text.size() - 1));
    return *sign;
  }
  return 0;
}

/// "4807.038": the last two digits before the point are whole minutes.
std::optional<double> degrees_and_minutes(std::string_view text) {
  const std::optional<double> number = field_number(text);
  if (!number || *number < 0) return std::nullopt;
  const double degrees = std::floor(*number / 100);
  const double minutes = *number - 100 * degrees;
  if (minutes >= 60) return std::nullopt;
  return degrees + minutes / 60;
}

/// Takes the next number of "48°7'2.3"" with what separates it from the following one.
std::optional<double> take_number(std::string_view& text) {
  const std::size_t length = std::min(text.find_first_not_of("0123456789."), text.size());
  const std::optional<double> number = field_number(text.substr(0, length));
  text.remove_prefix(length);
  const std::size_t next = text.find_first_of("0123456789");
  const std::string_view between = text.substr(0, next);
  if (between.size() > 4 || between.find_first_of("+-.,") != std::string_view::npos) return std::nullopt;
  text.remove_prefix(std::min(next, text.size()));
  return number;
}

std::optional<double> degrees_minutes_seconds(std::string_view text) {
  std::array<double, 3> parts{};
  for (std::size_t i = 0; i < parts.size() && !text.empty(); ++i) {
    const std::optional<double> number = take_number(text);
    // The last part may be rounded up to 60.
    if (!number || (i > 0 && *number > 60)) return std::nullopt;
    parts[i] = *number;
  }
  if (!text.empty()) return std::nullopt;
  return parts[0] + parts[1] / 60 + parts[2] / 3600;
}

}  // namespace

std::optional<double> hemisphere_from_field(std::string_view field) {
  const std::string word = lower_case(field);
  if (word == "n" || word == "e" || word == "north" || word == "east") return 1;
  if (word == "s" || word == "w" || word == "south" || word == "west") return -1;
  return std::nullopt;
}

std::optional<double> angle_from_field(std::string_view field, std::string_view unit) {
  std::string_view text = without_blanks(field);
  double sign = take_letter(text);
  if (sign == 0 && text.starts_with('-')) {
    sign = -1;
    text.remove_prefix(1);
  }
  if (sign == 0) sign = 1;
  if (text.empty() || text.front() < '0' || text.front() > '9') return std::nullopt;
  std::optional<double> size;
  if (unit == kDegreesMinutes) {
    size = degrees_and_minutes(text);
  } else if (unit == kDegreesMinutesSeconds) {
    size = degrees_minutes_seconds(text);
  } else {
    if (text.ends_with(kDegreeSign)) text.remove_suffix(kDegreeSign.size());
    size = field_number(without_blanks(text));
  }
  if (!size) return std::nullopt;
  return sign * *size;
}

}  // namespace waymark::formats
