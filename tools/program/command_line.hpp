/// The command line as a tree of subcommands and options. The parser, --help, the man pages and the
/// completion all use it, so they cannot differ.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <waymark/tools/program/commands/commands.hpp>

namespace waymark::program {

/// Adds every subcommand. @param action receives what the chosen subcommand does, after parsing
void build_command_line(CLI::App& app, Action& action);

/// Returns the subcommand with a name. @throws UsageError that names the nearest one, or all
[[nodiscard]] const CLI::App& find_command(const CLI::App& app, const std::string& name);

/// An environment variable or file that affects the program.
struct Surrounding {
  std::string name;
  std::string meaning;
};
[[nodiscard]] std::vector<Surrounding> environment_variables();
[[nodiscard]] std::vector<Surrounding> known_files();

}  // namespace waymark::program
