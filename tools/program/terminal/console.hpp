/// How the program talks: results on stdout, all else on stderr; progress and colours only on a terminal.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <waymark/core/base/error.hpp>
#include <waymark/core/optimize/summary.hpp>
#include <waymark/tools/program/terminal/progress.hpp>
#include <waymark/tools/text/text_look.hpp>

namespace waymark::program {

/// Options that every subcommand has.
struct CommonOptions {
  bool quiet = false;
  bool json = false;
  int verbosity = 0;
  std::vector<std::string> plugins;  ///< files or names of modules
};

/// Set by Ctrl-C; the optimizer looks at it before every step.
extern std::atomic<bool> interrupted;
/// Lets Ctrl-C end a run in good order; a second one kills. File size limits and closed pipes become errors.
void install_signal_handlers();

/// Ctrl-C before there was anything to keep.
class Interrupted : public Error {
 public:
  Interrupted() : Error("interrupted before there was a result") {}
};
/// Between steps other than the optimizer's. @throws Interrupted
void stop_if_interrupted();

class Console {
 public:
  explicit Console(const CommonOptions& options);
  /// A line of progress does not stay behind, an error neither.
  ~Console() { end_progress(); }
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  /// The command's result. With --quiet nothing but JSON is printed. @param to_stderr where stdout carries a
  /// file
  void result(const std::string& text, bool to_stderr = false) const;
  /// "warning: ...": something is or may be wrong. Like all below not printed with --quiet.
  void warning(const std::string& text) const;
  /// "note: ...": a sentence the user should know.
  void note(const std::string& text) const;
  /// A line as it is.
  void tell(const std::string& text) const;
  /// A line for -v.
  void detail(const std::string& text) const;
  /// Work in progress: shown on a terminal, cut to its width, overwritten by what follows.
  void progress(const std::string& text) const;
  void end_progress() const;

  [[nodiscard]] bool json() const { return options_.json; }
  [[nodiscard]] int verbosity() const { return options_.verbosity; }
  /// How text looks that goes to stdout, or to stderr.
  [[nodiscard]] text::TextLook look(bool to_stderr = false) const;

 private:
  CommonOptions options_;
  bool show_progress_;
  mutable bool progress_stands_ = false;
};

/// The line that a failure ends with: "waymark: error: ...".
[[nodiscard]] std::string error_line(const std::string& message);

/// Shows how far the reading of logs has come, and lets Ctrl-C end it: to be told of each piece read
/// (LogWatch).
/// @param console  must outlive what is returned
[[nodiscard]] std::function<void(const std::string& file, std::uint64_t done, std::uint64_t size)>
watch_reading(const Console& console);

/// Work of a known number of steps.
class StepProgress {
 public:
  StepProgress(const Console& console, std::size_t steps);
  /// Another step begins. @param text  what it is
  void next(const std::string& text);

  /// Steps begun.
  [[nodiscard]] std::size_t step() const { return step_; }
  /// What is shown: "TEXT  2:10 left".
  [[nodiscard]] const std::string& line() const { return line_; }

 private:
  const Console& console_;
  std::size_t steps_;
  std::size_t step_ = 0;
  ProgressMeter meter_;
  std::string line_;
};

}  // namespace waymark::program
