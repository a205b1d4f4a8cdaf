/// Tables for the terminal.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace waymark {

/// Rows under a heading, columns as wide as their widest cell; the first is flush left, the others flush
/// right.
class TextTable {
 public:
  using Row = std::vector<std::string>;

  explicit TextTable(Row heading) { rows_.push_back(std::move(heading)); }

  /// A row whose numbers stand there already under another label is not added again.
  void add_unless_known(Row row) {
    const bool known = std::any_of(rows_.begin() + 1, rows_.end(), [&](const Row& other) {
      return std::equal(row.begin() + 1, row.end(), other.begin() + 1, other.end());
    });
    if (!known) add(std::move(row));
  }

  void add(Row row) { rows_.push_back(std::move(row)); }
  [[nodiscard]] bool empty() const { return rows_.size() < 2; }

  [[nodiscard]] std::string text() const {
    std::vector<std::size_t> widths(rows_.front().size(), 0);
    for (const Row& row : rows_)
      for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
    std::string out;
    for (const Row& row : rows_) {
      std::string line = fmt::format("{:<{}}", row[0], widths[0]);
      for (std::size_t c = 1; c < row.size(); ++c) line += fmt::format("  {:>{}}", row[c], widths[c]);
      line.erase(line.find_last_not_of(' ') + 1);
      out += line + "\n";
    }
    return out;
  }

 private:
  std::vector<Row> rows_;
};

}  // namespace waymark
