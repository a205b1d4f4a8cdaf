/// Runs the built program as a user would, in its own process.
#pragma once

#include <string>
#include <string_view>
#include <vector>

struct RunOptions {
  std::string out_file{};  ///< standard output goes into this file (or device), not into a pipe
  /// send Ctrl-C (SIGINT) as soon as standard error contains this text
  std::string interrupt_at{};
  long file_size_limit = -1;  ///< bytes, as `ulimit -f`; -1: none
  std::string folder{};       ///< working folder; empty: the folder of the test
  bool close_output = false;  ///< close the reader of standard output, as in `waymark info | true`
  std::string program{};      ///< in place of the program that was built
};

struct RunResult {
  int code = -1;  ///< exit code; 1000 + number if a signal killed the program
  std::string out;
  std::string err;
};

/// Runs the program with the arguments and waits for it. A run of more than four minutes is killed.
[[nodiscard]] RunResult run(std::vector<std::string> arguments, const RunOptions& options = {});

/// Checks that the program refused: with this exit code, this text in its message, and no result.
void check_refused(const RunResult& result, int code, const std::string& message);

/// Called in a child process after its streams are set: becomes the program, or ends with 127.
[[noreturn]] void execute(std::vector<std::string>& arguments);
/// Appends the text that is ready. @return false at the end of the stream (a terminal whose other
/// side is closed gives EIO)
bool read_some(int descriptor, std::string& text);

/// Returns an empty folder for one test. It ends with '/', and is removed when the test
/// program ends.
[[nodiscard]] std::string fresh_folder();

/// Writes a file below the folder of this test. Returns its path.
std::string write_text(const std::string& path, std::string_view text);
[[nodiscard]] std::string read_text(const std::string& path);
[[nodiscard]] bool exists(const std::string& path);
/// Returns the sorted names in a folder, to check that no partial file was left.
[[nodiscard]] std::vector<std::string> names_in(const std::string& folder);
[[nodiscard]] bool contains(const std::string& text, const std::string& part);
