/// The help texts of the program, cut into words.
#pragma once

#include <string>
#include <vector>

[[nodiscard]] std::vector<std::string> lines_of(const std::string& text);

/// The words of a line, cut at spaces and commas.
[[nodiscard]] std::vector<std::string> words_of(const std::string& line);

/// Every subcommand, as `waymark --help` lists them.
[[nodiscard]] std::vector<std::string> subcommands();
