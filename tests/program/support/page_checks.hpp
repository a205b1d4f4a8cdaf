/// Checks for every page that the program writes.
#pragma once

#include <string>
#include <vector>

/// Returns the flaws of a page: a resource that is loaded, a duplicate id, a link within the
/// page without target, a figure without title or description, an invalid number. Empty if
/// there are none.
[[nodiscard]] std::vector<std::string> page_flaws(const std::string& html);

/// Returns the cells of the row that begins with `first`, in the table with this caption. Empty if
/// there is none.
[[nodiscard]] std::vector<std::string> table_row(const std::string& html, const std::string& caption,
                                                 const std::string& first);
/// Returns the headings of that table.
[[nodiscard]] std::vector<std::string> table_columns(const std::string& html, const std::string& caption);
