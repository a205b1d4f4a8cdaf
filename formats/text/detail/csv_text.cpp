#include <waymark/formats/text/detail/csv_text.hpp>

#include <charconv>
#include <cmath>

namespace waymark::formats {

void append_csv_text(std::string& out, std::string_view text) {
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
