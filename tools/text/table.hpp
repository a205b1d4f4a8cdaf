/// A table and its printers for the terminal, Markdown and CSV. `drawing::page_html` prints it as
/// HTML.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <waymark/tools/text/text_look.hpp>

namespace waymark::text {

using Row = std::vector<std::string>;

struct Table {
  std::string title{};               ///< empty: none
  Row columns{};                     ///< their headings; empty: the table has none
  std::vector<Row> rows{};           ///< the cells that a short row lacks are empty
  std::vector<std::string> notes{};  ///< sentences below the table
  std::string file{};                ///< name of its file without extension; empty: it has none
  bool words = false;                ///< no column has numbers, whatever its cells look like
  std::map<std::pair<std::size_t, std::size_t>, Tone> tones{};  ///< of cells, by row and column
};

/// Tells whether a column has more numbers than words. The first column names the rows, so it is
/// one of words.
[[nodiscard]] bool has_numbers(const Table& table, std::size_t column);

/// Returns headings and rows for the terminal. Each column is as wide as its widest cell. Columns
/// of words are flush left, columns of numbers flush right. If the terminal is too narrow, the
/// columns continue below; each part repeats the first column.
[[nodiscard]] std::string aligned_columns(const Table& table, const TextLook& look = {});
/// Returns title, aligned columns and notes for the terminal.
[[nodiscard]] std::string table_text(const Table& table, const TextLook& look = {});
/// Returns GitHub's Markdown, under a heading of second level. All columns but the first are flush
/// right.
[[nodiscard]] std::string table_markdown(const Table& table);
/// Returns CSV (RFC 4180 with "\n" line ends): headings and rows, without title and notes.
[[nodiscard]] std::string table_csv(const Table& table);

}  // namespace waymark::text
