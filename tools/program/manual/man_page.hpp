/// Man pages, in roff with the macros of man(7), from the tree of subcommands.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace waymark::program {

/// Returns the name of a command's page: "waymark", "waymark-run".
[[nodiscard]] std::string page_name(const CLI::App& command);

/// Returns the page of the program or of one of its subcommands: NAME, SYNOPSIS, DESCRIPTION,
/// OPTIONS by heading, EXIT STATUS, ENVIRONMENT, FILES, EXAMPLES, SEE ALSO.
/// @param date for the header, "2026-11-21"; may be empty
[[nodiscard]] std::string man_page(const CLI::App& command, const std::string& date);

/// Returns the day in the environment variable SOURCE_DATE_EPOCH (UTC), so that a build can be
/// repeated. Empty if it is not set. @throws UsageError if it holds no number of seconds
[[nodiscard]] std::string source_date();

}  // namespace waymark::program
