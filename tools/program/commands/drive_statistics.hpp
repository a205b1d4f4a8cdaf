/// The table of what a drive is like: `inspect DRIVE.yaml` and `simulate` print it.
#pragma once

#include <string>

#include <waymark/tools/program/commands/commands.hpp>

namespace waymark::program {

/// Reads the logs of a drive and prints the table, or the JSON document waymark-drive.
/// @throws InputError, UsageError for a drive.yaml or logs that are wrong
void print_drive_statistics(const std::string& path, const CommonOptions& common, const Console& console);

}  // namespace waymark::program
