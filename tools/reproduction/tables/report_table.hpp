/// A table of a report and its output formats.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/text/text_look.hpp>

namespace waymark::reproduction {

struct ReportTable {
  std::string file;   ///< name of its CSV without extension
  std::string title;  ///< it names the simulated drives
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  ///< each as long as `columns`
  std::vector<std::string> notes;              ///< sentences below the table
};

/// Returns title, aligned columns and notes for the terminal.
[[nodiscard]] std::string table_text(const ReportTable& table, const text::TextLook& look = {});
/// Returns GitHub's Markdown, under a heading of second level.
[[nodiscard]] std::string table_markdown(const ReportTable& table);
/// Returns CSV (RFC 4180): the names of the columns, then the rows, without title and notes.
[[nodiscard]] std::string table_csv(const ReportTable& table);

/// Returns "-" if the number is undefined.
[[nodiscard]] std::string cell(double value, int digits);

}  // namespace waymark::reproduction
