#include <waymark/formats/text/detail/csv_text.hpp>
#include <waymark/tools/text/table.hpp>

namespace waymark::text {
namespace {

std::string markdown_row(const Row& row) {
  std::string line = "|";
  for (const std::string& cell : row) {
    line += ' ';
    for (const char c : cell) {
      if (c == '|') line += '\\';  // it would end the cell
      line += c;
    }
    line += " |";
  }
  return line + "\n";
}

void append_csv_row(const Row& row, std::string& csv) {
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (i > 0) csv += ',';
    formats::append_csv_text(csv, row[i]);
  }
  csv += '\n';
}

}  // namespace

std::string table_markdown(const Table& table) {
  std::string out = "## " + table.title + "\n\n" + markdown_row(table.columns) + "|---|";
  for (std::size_t i = 1; i < table.columns.size(); ++i) out += "---:|";
  out += "\n";
  for (const Row& row : table.rows) out += markdown_row(row);
  if (!table.notes.empty()) out += "\n";
  for (const std::string& note : table.notes) out += "- " + note + "\n";
  return out;
}

std::string table_csv(const Table& table) {
  std::string csv;
  append_csv_row(table.columns, csv);
  for (const Row& row : table.rows) append_csv_row(row, csv);
  return csv;
}

}  // namespace waymark::text
