/// A table of a report, and how it is written.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/text/text_look.hpp>

namespace waymark::reproduction {

struct ReportTable {
  std::string file;   ///< name of its CSV without ending
  std::string title;  ///< says what is simulated
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  ///< each as long as `columns`
  std::vector<std::string> notes;              ///< sentences below it
};

/// For the terminal: title, aligned columns, notes.
[[nodiscard]] std::string table_text(const ReportTable& table, const text::TextLook& look = {});
/// GitHub's Markdown, under a heading of second level.
[[nodiscard]] std::string table_markdown(const ReportTable& table);
/// RFC 4180: the columns' names, then the rows. Without title and notes.
[[nodiscard]] std::string table_csv(const ReportTable& table);

/// "-" where a number is not defined.
[[nodiscard]] std::string cell(double value, int digits);

}  // namespace waymark::reproduction
