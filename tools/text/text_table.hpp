/// Tables for the terminal.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include <waymark/tools/text/text_look.hpp>

namespace waymark::text {

/// Rows under a heading. Each column is as wide as its widest cell. The first column and columns of
/// words are flush left, columns of numbers flush right. If the terminal is too narrow, the table
/// continues below itself; each part repeats the first column.
class TextTable {
 public:
  using Row = std::vector<std::string>;

  explicit TextTable(Row heading) { rows_.push_back(std::move(heading)); }

  /// Adds a row, unless another label already has the same numbers.
  void add_unless_known(Row row);
  void add(Row row) { rows_.push_back(std::move(row)); }
  /// Paints a cell of the last row.
  void paint(std::size_t column, Tone tone) { tones_[{rows_.size() - 1, column}] = tone; }

  [[nodiscard]] bool empty() const { return rows_.size() < 2; }
  [[nodiscard]] std::string text(const TextLook& look = {}) const;

 private:
  [[nodiscard]] bool of_words(std::size_t column) const;
  [[nodiscard]] std::string part(std::size_t first, std::size_t last, const std::vector<std::size_t>& widths,
                                 const TextLook& look) const;

  std::vector<Row> rows_;  ///< the heading first
  std::map<std::pair<std::size_t, std::size_t>, Tone> tones_;
};

}  // namespace waymark::text
