#include <algorithm>

#include <waymark/tools/text/table.hpp>

namespace waymark::text {
namespace {

constexpr std::size_t kGap = 2;  // between columns

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// "-" stands for an undefined number.
bool looks_like_number(const std::string& cell) {
  if (cell == "-" || is_digit(cell.front())) return true;
  const bool signed_or_point = cell.front() == '-' || cell.front() == '+' || cell.front() == '.';
  return signed_or_point && is_digit(cell[1]);
}

/// "10 minutes of motorway" is a sentence; an interval "0.24 - 5.57" and "10 Hz" are not.
bool is_sentence(const std::string& cell) {
  return std::count(cell.begin(), cell.end(), ' ') > 2;
}

struct Column {
  std::size_t index = 0;
  std::size_t width = 0;
  bool numbers = false;
};

std::vector<Column> columns_of(const Table& table) {
  std::vector<Column> columns;
  const auto widen = [&](const Row& row) {
    while (columns.size() < row.size())
      columns.push_back({.index = columns.size(), .numbers = has_numbers(table, columns.size())});
    for (std::size_t c = 0; c < row.size(); ++c)
      columns[c].width = std::max(columns[c].width, display_width(row[c]));
  };
  widen(table.columns);
  for (const Row& row : table.rows) widen(row);
  return columns;
}

/// Returns a line of these columns. @param paint gives a cell that is not empty its colour
template <typename Paint>
std::string line_of(const Row& row, const std::vector<Column>& columns, const Paint& paint) {
  std::string line;
  std::string spaces;  // written only before other text
  for (const Column& column : columns) {
    const std::string cell = column.index < row.size() ? row[column.index] : "";
    const std::string padding(column.width - display_width(cell), ' ');
    if (column.numbers) spaces += padding;
    if (!cell.empty()) line += std::exchange(spaces, {}) + paint(cell, column.index);
    if (!column.numbers) spaces += padding;
    spaces.append(kGap, ' ');
  }
  return line + "\n";
}

std::string part(const Table& table, const std::vector<Column>& columns, const TextLook& look) {
  std::string out;
  if (!table.columns.empty()) {
    out += line_of(table.columns, columns,
                   [&](const std::string& cell, std::size_t) { return painted(cell, Tone::heading, look); });
  }
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    out += line_of(table.rows[r], columns, [&](const std::string& cell, std::size_t c) {
      const auto tone = table.tones.find({r, c});
      return tone == table.tones.end() ? cell : painted(cell, tone->second, look);
    });
  }
  return out;
}

}  // namespace

bool has_numbers(const Table& table, std::size_t column) {
  if (table.words || column == 0) return false;
  std::size_t numbers = 0;
  std::size_t words = 0;  // "1" is also a unit
  for (const Row& row : table.rows) {
    if (column >= row.size() || row[column].empty()) continue;
    if (is_sentence(row[column])) return false;
    ++(looks_like_number(row[column]) ? numbers : words);
  }
  return numbers > words;
}

std::string aligned_columns(const Table& table, const TextLook& look) {
  const std::vector<Column> columns = columns_of(table);
  if (columns.empty()) return {};
  std::string out;
  for (auto next = columns.begin() + 1; out.empty() || next != columns.end();) {
    std::vector<Column> shown = {columns.front()};
    std::size_t width = shown.front().width;
    while (next != columns.end() &&
           (shown.size() == 1 || look.columns == 0 || width + kGap + next->width <= look.columns)) {
      width += kGap + next->width;
      shown.push_back(*next++);
    }
    out += part(table, shown, look);
  }
  return out;
}

std::string table_text(const Table& table, const TextLook& look) {
  std::string out;
  if (!table.title.empty()) out += painted(table.title, Tone::heading, look) + "\n";
  out += aligned_columns(table, look);
  for (const std::string& note : table.notes) out += "  " + note + "\n";
  return out;
}

}  // namespace waymark::text
