/// The output of the program: results on stdout, everything else on stderr. Progress and colours
/// appear only on a terminal. A host of the jobs that has no terminal listens instead (Listener).
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
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

/// Set by Ctrl-C. The optimizer checks it before every step.
extern std::atomic<bool> interrupted;
/// Makes Ctrl-C and SIGTERM end a run in an orderly way; a second Ctrl-C kills it. File size limits
/// and closed pipes become errors.
void install_signal_handlers();

/// Ctrl-C before there was a result to keep.
class Interrupted : public Error {
 public:
  Interrupted() : Error("interrupted before there was a result") {}
};
/// Call it between steps other than those of the optimizer. @throws Interrupted
void stop_if_interrupted();

/// What a job says, for a host that is no terminal: the Python package. All members may be empty.
struct Listener {
  enum class Kind { warning, note, detail };
  std::function<void(Kind kind, const std::string& text)> said{};
  std::function<void(const std::string& text)> progress{};
  /// of every optimisation; `work` is its name and may be empty
  std::function<void(const std::string& work, const IterationRecord& record)> step{};
  /// called between steps that are long and say nothing
  std::function<void()> waits{};
  /// ends the work as Ctrl-C ends that of the program
  const std::atomic<bool>* cancel = nullptr;
};

class Console {
 public:
  explicit Console(const CommonOptions& options);
  /// A console that prints nothing but tells a listener.
  Console(const CommonOptions& options, Listener listener);
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
  /// Tells a listener of a step of the optimizer. Returns whether there is a listener.
  bool step(const std::string& work, const IterationRecord& record) const;

  /// Returns what ends the work: that of the listener, or Ctrl-C. The optimizer checks it before
  /// every step.
  [[nodiscard]] const std::atomic<bool>& cancel() const;
  /// Call it between steps other than those of the optimizer. @throws Interrupted
  void stop_if_cancelled() const;

  [[nodiscard]] bool json() const { return options_.json; }
  [[nodiscard]] int verbosity() const { return options_.verbosity; }
  /// Returns the look of text on stdout, or on stderr.
  [[nodiscard]] text::TextLook look(bool to_stderr = false) const;

 private:
  /// Tells the listener. Returns whether there is one.
  bool heard(Listener::Kind kind, const std::string& text) const;

  CommonOptions options_;
  std::optional<Listener> listener_;
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
