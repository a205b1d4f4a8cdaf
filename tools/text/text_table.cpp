#include <waymark/tools/text/text_table.hpp>

#include <algorithm>

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

}  // namespace

void TextTable::add_unless_known(Row row) {
  const bool known = std::any_of(rows_.begin() + 1, rows_.end(), [&](const Row& other) {
    return std::equal(row.begin() + 1, row.end(), other.begin() + 1, other.end());
  });
  if (!known) add(std::move(row));
}

bool TextTable::of_words(std::size_t column) const {
  std::size_t numbers = 0;
  std::size_t words = 0;
  for (auto row = rows_.begin() + 1; row != rows_.end() && column > 0; ++row) {
    if (column >= row->size() || (*row)[column].empty()) continue;
    if (is_sentence((*row)[column])) return true;
    ++(looks_like_number((*row)[column]) ? numbers : words);
  }
  return words >= numbers;  // "1" is also a unit
}

std::string TextTable::text(const TextLook& look) const {
  std::vector<std::size_t> widths(rows_.front().size(), 0);
  for (const Row& row : rows_)
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], display_width(row[c]));
  std::string out;
  for (std::size_t first = 1; out.empty() || first < widths.size();) {
    std::size_t width = widths[0];
    std::size_t last = first;
    while (last < widths.size() &&
           (last == first || look.columns == 0 || width + kGap + widths[last] <= look.columns)) {
      width += kGap + widths[last++];
    }
    out += part(first, last, widths, look);
    first = last;
  }
  return out;
}

std::string TextTable::part(std::size_t first, std::size_t last, const std::vector<std::size_t>& widths,
                            const TextLook& look) const {
  std::vector<std::size_t> columns = {0};
  for (std::size_t c = first; c < last; ++c) columns.push_back(c);
  std::string out;
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    std::string line;
    std::string spaces;  // written only before other text
    for (const std::size_t c : columns) {
      const std::string cell = c < rows_[r].size() ? rows_[r][c] : "";
      const std::string padding(widths[c] - display_width(cell), ' ');
      const bool words = of_words(c);
      if (!words) spaces += padding;
      if (!cell.empty()) {
        const auto tone = tones_.find({r, c});
        line += spaces;
        line += r == 0                 ? painted(cell, Tone::heading, look)
                : tone != tones_.end() ? painted(cell, tone->second, look)
                                       : cell;
        spaces.clear();
      }
      if (words) spaces += padding;
      spaces.append(kGap, ' ');
    }
    out += line + "\n";
  }
  return out;
}

}  // namespace waymark::text
