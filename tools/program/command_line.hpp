/// The command line as a tree of subcommands and options. The parser reads it, and --help, the man pages and
/// the completion are printed from it, so that they cannot differ.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <waymark/tools/program/commands/commands.hpp>

namespace waymark::program {

/// Adds every subcommand. @param action  what the chosen one does, after parsing
void build_command_line(CLI::App& app, Action& action);

/// The subcommand of a name. @throws UsageError that names the nearest one, or all
[[nodiscard]] const CLI::App& find_command(const CLI::App& app, const std::string& name);

/// A thing outside the command line that the program heeds.
struct Surrounding {
  std::string name;
  std::string meaning;
};
[[nodiscard]] std::vector<Surrounding> environment_variables();
[[nodiscard]] std::vector<Surrounding> known_files();

}  // namespace waymark::program
