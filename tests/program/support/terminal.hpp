/// Runs the built program on a pseudo terminal, and returns what a user would see.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "program/support/program.hpp"

struct Terminal {
  unsigned columns = 80;
  std::map<std::string, std::string> environment = {
      {"TERM", "xterm"}};    ///< added to the environment; NO_COLOR is removed
  bool out_in_pipe = false;  ///< only standard error is on the terminal
};

/// In the result, RunResult::err is the text on the terminal, with "\n" for its "\r\n".
/// RunResult::out is the text from the pipe.
[[nodiscard]] RunResult run_on(const Terminal& terminal, std::vector<std::string> arguments);

/// Returns the lines that remain on a screen after carriage returns and "erase to the end of the
/// line". Colours are removed.
[[nodiscard]] std::vector<std::string> screen_of(const std::string& text);

/// Returns every text that was in a line, also those that were overwritten.
[[nodiscard]] std::vector<std::string> shown_in(const std::string& text);
