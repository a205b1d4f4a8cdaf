/// Runs the built program on a pseudo terminal, and shows what a user would then see.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "program/support/program.hpp"

struct Terminal {
  unsigned columns = 80;
  std::map<std::string, std::string> environment = {
      {"TERM", "xterm"}};    ///< beside what is there; NO_COLOR is not
  bool out_in_pipe = false;  ///< standard error alone is on the terminal
};

/// RunResult::err is what came on the terminal, with "\n" for its "\r\n"; RunResult::out what came through
/// the pipe.
[[nodiscard]] RunResult run_on(const Terminal& terminal, std::vector<std::string> arguments);

/// The lines that stay on a screen: what carriage returns and "erase to the end of the line" leave. Colours
/// are taken away.
[[nodiscard]] std::vector<std::string> screen_of(const std::string& text);

/// Every text that stood in a line, those that were overwritten too.
[[nodiscard]] std::vector<std::string> shown_in(const std::string& text);
