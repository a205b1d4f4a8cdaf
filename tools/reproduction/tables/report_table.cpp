#include <cmath>

#include <fmt/format.h>

#include <waymark/tools/reproduction/tables/report_table.hpp>
#include <waymark/tools/text/text_table.hpp>

namespace waymark::reproduction {
namespace {

/// A "|" would end the cell.
std::string markdown_cell(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + "\"";
}

template <typename Cell>
std::string joined_cells(const std::vector<std::string>& cells, const char* separator, Cell format) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i > 0) line += separator;
    line += format(cells[i]);
  }
  return line;
}

std::string markdown_row(const std::vector<std::string>& cells) {
  return "| " + joined_cells(cells, " | ", markdown_cell) + " |\n";
}

}  // namespace

std::string table_text(const ReportTable& table, const text::TextLook& look) {
  text::TextTable text(table.columns);
  for (const auto& row : table.rows) text.add(row);
  std::string out = text::painted(table.title, text::Tone::heading, look) + "\n" + text.text(look);
  for (const std::string& note : table.notes) out += "  " + note + "\n";
  return out;
}

std::string table_markdown(const ReportTable& table) {
  std::string out = "## " + table.title + "\n\n" + markdown_row(table.columns) + "|---|";
  for (std::size_t i = 1; i < table.columns.size(); ++i) out += "---:|";
  out += "\n";
  for (const auto& row : table.rows) out += markdown_row(row);
  if (!table.notes.empty()) out += "\n";
  for (const std::string& note : table.notes) out += "- " + note + "\n";
  return out;
}

std::string table_csv(const ReportTable& table) {
  std::string out = joined_cells(table.columns, ",", csv_cell) + "\n";
  for (const auto& row : table.rows) out += joined_cells(row, ",", csv_cell) + "\n";
  return out;
}

std::string cell(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "-";
}

}  // namespace waymark::reproduction
