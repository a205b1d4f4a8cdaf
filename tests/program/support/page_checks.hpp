/// What every page that the program writes must be.
#pragma once

#include <string>
#include <vector>

/// What is wrong with a page: something loaded from elsewhere, an id that is there twice, a link within the
/// page to nothing, a figure without title or description, a number that is none. Empty: nothing.
[[nodiscard]] std::vector<std::string> page_flaws(const std::string& html);

/// Cells of a table's row that begins with `first`, in the table with this caption; empty where there is
/// none.
[[nodiscard]] std::vector<std::string> table_row(const std::string& html, const std::string& caption,
                                                 const std::string& first);
/// The headings of that table.
[[nodiscard]] std::vector<std::string> table_columns(const std::string& html, const std::string& caption);
