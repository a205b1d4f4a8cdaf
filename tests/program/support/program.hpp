/// Runs the built program as a user would, in a process of its own.
#pragma once

#include <string>
#include <string_view>
#include <vector>

struct RunOptions {
  std::string out_file{};      ///< standard output goes into this file (or device) instead of a pipe
  std::string interrupt_at{};  ///< Ctrl-C (SIGINT) as soon as standard error holds this text
  long file_size_limit = -1;   ///< bytes, as `ulimit -f`; -1: none
  std::string folder{};        ///< working folder; empty: the test's
  bool close_output = false;   ///< the reader of standard output has gone, as in `waymark info | true`
  std::string program{};       ///< instead of WAYMARK_PROGRAM
};

struct RunResult {
  int code = -1;  ///< exit code; 1000 + number where a signal killed the program
  std::string out;
  std::string err;
};

/// Runs the program with the arguments and waits for it. A run of over a minute is killed.
[[nodiscard]] RunResult run(std::vector<std::string> arguments, const RunOptions& options = {});

/// In a child process, after its streams were set: becomes the program, or ends with 127.
[[noreturn]] void execute(std::vector<std::string>& arguments);
/// Appends what is there to read. @return false at the end of the stream (a terminal whose other side has
/// gone gives EIO)
bool read_some(int descriptor, std::string& text);

/// An empty folder for one test, removed when the test program ends. Ends with '/'.
[[nodiscard]] std::string fresh_folder();

/// Writes a file below the folder of this test; returns its path.
std::string write_text(const std::string& path, std::string_view text);
[[nodiscard]] std::string read_text(const std::string& path);
[[nodiscard]] bool exists(const std::string& path);
/// Names in a folder, sorted: to see that nothing partial was left.
[[nodiscard]] std::vector<std::string> names_in(const std::string& folder);
[[nodiscard]] bool contains(const std::string& text, const std::string& part);
