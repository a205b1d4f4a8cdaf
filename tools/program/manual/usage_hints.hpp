/// Reads a command line as far as hints need it: the option that was probably meant, or the command that
/// it belongs to; the file.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace waymark::program {

/// Returns the error of the first word of a refused command line that looks like an option and is
/// none of its subcommand: "unknown option '--modelling'; did you mean '--modeling'?", "unknown
/// option '--withhold'; --withhold belongs to: run, convert". Empty if all such words are known.
/// @param words words of the command line without the name of the program
[[nodiscard]] std::string unknown_option(const CLI::App& app, const std::vector<std::string>& words);

/// Returns the only word behind the subcommand that is neither an option nor the value of one. Empty: there is
/// none or several, or an option is unknown, or states the format of the input.
[[nodiscard]] std::string only_file(const CLI::App& app, const std::vector<std::string>& words);

/// Accepts one of these words. Its error is "unknown format 'g20'; did you mean 'g2o'?". @param
/// kind "format"
[[nodiscard]] CLI::Validator one_of(const std::string& kind, const std::vector<std::string>& words);

}  // namespace waymark::program
