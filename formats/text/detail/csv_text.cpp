#include <waymark/formats/text/detail/csv_text.hpp>

#include <charconv>
#include <cmath>

namespace waymark::formats {

namespace {

/// Tells whether a spreadsheet would take the text for a formula and compute it. A number is none.
bool is_formula(std::string_view text) {
  if (text.empty() || std::string_view("=+-@\t\r").find(text.front()) == std::string_view::npos) return false;
  const bool sign = text.front() == '+' || text.front() == '-';
  const char* end = text.data() + text.size();
  double number = 0;
  const auto result = std::from_chars(text.data() + (sign ? 1 : 0), end, number);
  return text.size() > 1 && !(sign && result.ec == std::errc() && result.ptr == end);
}

}  // namespace

void append_csv_text(std::string& out, std::string_view text) {
  if (is_formula(text)) return append_csv_text(out, "'" + std::string(text));
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) {
    out += text;
    return;
  }
  out += '"';
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  out += '"';
}

void append_csv_number(std::string& out, const std::optional<double>& value) {
  out += ',';
  if (!value || !std::isfinite(*value)) return;
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, *value);
  out.append(buffer, result.ptr);
}

}  // namespace waymark::formats
