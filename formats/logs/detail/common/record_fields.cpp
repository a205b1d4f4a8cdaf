#include <waymark/formats/logs/detail/common/record_fields.hpp>

#include <charconv>
#include <cmath>

#include <waymark/formats/text/detail/decimal.hpp>
#include <waymark/formats/text/detail/line_scanner.hpp>

namespace waymark::formats {

namespace {

bool separates(char c) {
  return c == ' ' || c == ',' || c == '\t' || c == ';';
}

}  // namespace

void RecordFields::add(std::string_view field) {
  if (count_ < kKept) kept_[count_] = field;
  ++count_;
}

void RecordFields::split_words(std::string_view line) {
  line_ = line;
  count_ = 0;
  std::size_t place = 0;
  while (place < line.size()) {
    if (separates(line[place])) {
      ++place;
      continue;
    }
    const std::size_t begin = place;
    while (place < line.size() && !separates(line[place])) ++place;
    add(line.substr(begin, place - begin));
  }
}

void RecordFields::split_at(std::string_view line, char separator) {
  line_ = line;
  count_ = 0;
  std::size_t begin = 0;
  bool quoted = false;
  for (std::size_t place = 0; place < line.size(); ++place) {
    if (line[place] == '"') quoted = !quoted;
    if (line[place] != separator || quoted) continue;
    add(line.substr(begin, place - begin));
    begin = place + 1;
  }
  add(line.substr(begin));
}

std::size_t RecordFields::column(std::size_t index) const {
  if (index >= count_ || index >= kKept) return line_.size() + 1;
  return static_cast<std::size_t>(kept_[index].data() - line_.data()) + 1;
}

std::string quote_field(std::string_view field) {
  return field.empty() ? "''" : quote_word(field);
}

std::optional<double> field_number(std::string_view field) {
  const char* const end = field.data() + field.size();
  const Decimal plain = read_plain_decimal(field.data(), end);
  if (plain.end == end && !field.empty()) return plain.value;
  if (field.size() > 1 && field.front() == '+' && field[1] != '-') field.remove_prefix(1);
  double value = 0;
  const auto [stop, error] = std::from_chars(field.data(), end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<int> field_count(std::string_view field) {
  if (field.empty() || field.size() > 9) return std::nullopt;
  int value = 0;
  for (const char c : field) {
    if (c < '0' || c > '9') return std::nullopt;
    value = 10 * value + (c - '0');
  }
  return value;
}

}  // namespace waymark::formats
