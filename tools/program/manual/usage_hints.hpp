/// What a user who mistyped an option is told: the option that was meant, or whose option it is.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace waymark::program {

/// What is wrong with the first word of a refused command line that looks like an option and is none of its
/// subcommand: "unknown option '--modelling'; did you mean '--modeling'?", "unknown option '--withhold';
/// --withhold belongs to: run, convert". Empty where every such word is known.
/// @param words  of the command line, the program's name not among them
[[nodiscard]] std::string unknown_option(const CLI::App& app, const std::vector<std::string>& words);

/// One of these words: "unknown format 'g20'; did you mean 'g2o'?". @param kind "format"
[[nodiscard]] CLI::Validator one_of(const std::string& kind, const std::vector<std::string>& words);

}  // namespace waymark::program
