#include <waymark/formats/logs/detail/csv/csv_table.hpp>

#include <algorithm>

#include <waymark/formats/text/detail/characters.hpp>

namespace waymark::formats {
namespace {

/// Takes the separator before the next field. @return false at the end of the line.
bool take_separator(std::string_view& rest, char separator) {
  if (rest.empty()) return false;
  if (separator != ' ') {
    rest.remove_prefix(1);
    return true;
  }
  rest = without_blanks(rest);
  return !rest.empty();
}

std::size_t find_separator(std::string_view text, char separator) {
  const std::size_t at = separator == ' ' ? text.find_first_of(" \t") : text.find(separator);
  return at == std::string_view::npos ? text.size() : at;
}

/// Takes a field that starts with a quote; doubled quotes do not end it. @return false if the quote
/// is not closed or text follows the closing quote
bool take_quoted(std::string_view& rest, char separator, std::string_view& field) {
  std::size_t end = 1;
  while (true) {
    end = rest.find('"', end);
    if (end == std::string_view::npos) return false;
    if (end + 1 >= rest.size() || rest[end + 1] != '"') break;
    end += 2;
  }
  field = rest.substr(1, end - 1);
  rest.remove_prefix(end + 1);
  const std::size_t next = find_separator(rest, separator);
  const bool clean = without_blanks(rest.substr(0, next)).empty();
  rest.remove_prefix(next);
  return clean;
}

}  // namespace

bool CsvLines::next() {
  comment_ = {};
  while (!rest_.empty()) {
    const std::size_t end = rest_.find('\n');
    line_ = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++number_;
    if (!line_.empty() && line_.back() == '\r') line_.remove_suffix(1);
    const std::string_view content = without_blanks(line_);
    if (content.empty()) continue;
    if (content.front() != '#') return true;
    comment_ = content.substr(1);
  }
  return false;
}

char separator_of(std::string_view header) {
  char best = ' ';
  std::ptrdiff_t most = 0;
  for (const char candidate : {',', ';', '\t'}) {
    const std::ptrdiff_t count = std::count(header.begin(), header.end(), candidate);
    if (count > most) {
      most = count;
      best = candidate;
    }
  }
  return best;
}

bool split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields) {
  fields.clear();
  std::string_view rest = separator == ' ' ? without_blanks(line) : line;
  do {
    std::string_view after_blanks = rest;
    while (!after_blanks.empty() && is_blank(after_blanks.front()) && after_blanks.front() != separator)
      after_blanks.remove_prefix(1);
    if (!after_blanks.empty() && after_blanks.front() == '"') {
      rest = after_blanks;
      std::string_view field;
      if (!take_quoted(rest, separator, field)) return false;
      fields.push_back(without_blanks(field));
    } else {
      const std::size_t end = find_separator(rest, separator);
      fields.push_back(without_blanks(rest.substr(0, end)));
      rest.remove_prefix(end);
    }
  } while (take_separator(rest, separator));
  return true;
}

}  // namespace waymark::formats
