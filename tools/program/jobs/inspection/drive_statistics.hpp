/// The table of a drive's statistics. `inspect DRIVE.yaml` and `simulate` print it.
#pragma once

#include <string>

#include <waymark/tools/program/commands/commands.hpp>

namespace waymark::program {

/// Reads the logs of a drive and prints the table, or the JSON document waymark-drive.
/// @throws InputError, UsageError for a wrong drive.yaml or wrong logs
void print_drive_statistics(const std::string& path, const CommonOptions& common, const Console& console);

}  // namespace waymark::program
