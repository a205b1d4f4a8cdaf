/// How the program talks: results on stdout, all else on stderr; progress only on a terminal.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <waymark/core/error.hpp>
#include <waymark/core/summary.hpp>

namespace waymark {

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
  Interrupted() : Error("interrupted; nothing was written") {}
};
/// Between steps other than the optimizer's. @throws Interrupted
void stop_if_interrupted();

class Console {
 public:
  explicit Console(const CommonOptions& options);

  /// The command's result. With --quiet nothing but JSON is printed. @param to_stderr where stdout carries a
  /// file
  void result(const std::string& text, bool to_stderr = false) const;
  /// A sentence the user should know; not printed with --quiet.
  void note(const std::string& text) const;
  /// A sentence for -v.
  void detail(const std::string& text) const;
  /// Work in progress: shown on a terminal, overwritten by what follows.
  void progress(const std::string& text) const;
  void end_progress() const;

  [[nodiscard]] bool json() const { return options_.json; }
  [[nodiscard]] int verbosity() const { return options_.verbosity; }

 private:
  CommonOptions options_;
  bool show_progress_;
};

/// Shows how far the reading of a log has come, and lets Ctrl-C end it: to be told of each piece read
/// (LogWatch).
/// @param console  must outlive what is returned
[[nodiscard]] std::function<void(const std::string& file, std::uint64_t done, std::uint64_t size)>
watch_reading(const Console& console);

}  // namespace waymark
