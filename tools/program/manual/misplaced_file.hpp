/// A hint for a file of the wrong kind: a log given to a command that wants a drive, a drive given to one that
/// wants a graph.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace waymark::program {

/// Returns two lines: what the only file on the command line is and what its subcommand wants, and the
/// command to type. Empty if there is no such file, or it is of a wanted kind, or of none that is known.
/// @param words words of the command line without the name of the program
[[nodiscard]] std::string misplaced_file(const CLI::App& app, const std::vector<std::string>& words);

}  // namespace waymark::program
