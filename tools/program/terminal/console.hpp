/// The output of the program: results on stdout, everything else on stderr. Progress and colours
/// appear only on a terminal.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <waymark/core/base/error.hpp>
#include <waymark/core/optimize/summary.hpp>
#include <waymark/tools/drive/model/interrupted.hpp>
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

/// Set by Ctrl-C. The optimizer checks it before every step.
extern std::atomic<bool> interrupted;
/// Makes Ctrl-C end a run in an orderly way; a second one kills it. File size limits and closed
/// pipes become errors.
void install_signal_handlers();

/// Ctrl-C before there was a result to keep.
using drive::Interrupted;
/// Call it between steps other than those of the optimizer. @throws Interrupted
void stop_if_interrupted();

class Console {
 public:
  explicit Console(const CommonOptions& options);
  /// Clears the progress line, also after an exception.
  ~Console() { end_progress(); }
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  /// Prints the result of the command. With --quiet only JSON is printed. @param to_stderr if
  /// stdout carries a file
  void result(const std::string& text, bool to_stderr = false) const;
  /// Prints "warning: ...": something is or may be wrong. --quiet suppresses this and
  /// everything below.
  void warning(const std::string& text) const;
  /// Prints "note: ...": a sentence that the user should know.
  void note(const std::string& text) const;
  /// Prints a line as it is.
  void tell(const std::string& text) const;
  /// Prints a line with -v.
  void detail(const std::string& text) const;
  /// Shows work in progress on a terminal, cut to its width. The next output overwrites it.
  void progress(const std::string& text) const;
  void end_progress() const;

  [[nodiscard]] bool json() const { return options_.json; }
  [[nodiscard]] int verbosity() const { return options_.verbosity; }
  /// Returns the look of text on stdout, or on stderr.
  [[nodiscard]] text::TextLook look(bool to_stderr = false) const;

 private:
  CommonOptions options_;
  bool show_progress_;
  mutable bool progress_stands_ = false;
};

/// Returns the line that ends a failure: "waymark: error: ...".
[[nodiscard]] std::string error_line(const std::string& message);

/// Returns a function that shows how much of the logs is read, and lets Ctrl-C stop it. It is
/// called for each piece that is read (LogWatch).
/// @param console must outlive the function
[[nodiscard]] std::function<void(const std::string& file, std::uint64_t done, std::uint64_t size)>
watch_reading(const Console& console);

/// Progress of work with a known number of steps.
class StepProgress {
 public:
  StepProgress(const Console& console, std::size_t steps);
  /// Begins the next step. @param text name of the step
  void next(const std::string& text);

  /// Returns how many steps have begun.
  [[nodiscard]] std::size_t step() const { return step_; }
  /// Returns the line that is shown: "TEXT  2:10 left".
  [[nodiscard]] const std::string& line() const { return line_; }

 private:
  const Console& console_;
  std::size_t steps_;
  std::size_t step_ = 0;
  ProgressMeter meter_;
  std::string line_;
};

}  // namespace waymark::program
