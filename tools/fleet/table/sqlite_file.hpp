/// The merged table as a database.
#pragma once

#include <string>

#include <waymark/tools/fleet/table/fleet_table.hpp>

namespace waymark::fleet {

/// Returns the bytes of an SQLite database with three tables. `drives` has the columns and rows of
/// merged_table, with numbers as REAL and undefined ones as NULL. `columns` explains the numbers.
/// `fleet` has the label and the options. The same fleet gives the same bytes.
/// @throws OutputError if SQLite fails
[[nodiscard]] std::string sqlite_bytes(const Fleet& fleet);

/// Returns the version of the SQLite that is linked: "3.40.1".
[[nodiscard]] std::string sqlite_version();

}  // namespace waymark::fleet
