#include <unistd.h>
#include <chrono>
#include <csignal>
#include <cstdio>

#include <fmt/format.h>

#include <waymark/core/error.hpp>
#include <waymark/formats/text_file.hpp>
#include <waymark/tools/program/console.hpp>

namespace waymark {

std::atomic<bool> interrupted{false};

namespace {

extern "C" void on_interrupt(int signal) {
  if (interrupted.exchange(true)) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
}

}  // namespace

void install_signal_handlers() {
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
}

void stop_if_interrupted() {
  if (interrupted) throw Interrupted();
}

Console::Console(const CommonOptions& options)
    : options_(options), show_progress_(!options.quiet && ::isatty(STDERR_FILENO) == 1) {}

void Console::result(const std::string& text, bool to_stderr) const {
  if (options_.quiet && !options_.json) return;
  end_progress();
  if (to_stderr) {
    std::fputs(text.c_str(), stderr);
  } else {
    write_file_atomically("-", text);
  }
}

void Console::note(const std::string& text) const {
  if (options_.quiet) return;
  end_progress();
  std::fprintf(stderr, "%s\n", text.c_str());
}

void Console::detail(const std::string& text) const {
  if (options_.verbosity > 0) note(text);
}

void Console::progress(const std::string& text) const {
  if (show_progress_) std::fprintf(stderr, "\r\033[K%s", text.c_str());
}

void Console::end_progress() const {
  if (show_progress_) std::fputs("\r\033[K", stderr);
}

std::function<void(const std::string& file, std::uint64_t done, std::uint64_t size)> watch_reading(
    const Console& console) {
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kBetween{100};
  return [&console, shown = Clock::time_point{}](const std::string& file, std::uint64_t done,
                                                 std::uint64_t size) mutable {
    stop_if_interrupted();
    const Clock::time_point now = Clock::now();
    if (now - shown < kBetween) return;
    shown = now;
    const std::string name = file.substr(file.find_last_of('/') + 1);
    console.progress(size > 0 ? fmt::format("reading {}: {} of {} MB, {} %", name, done >> 20U, size >> 20U,
                                            100 * done / size)
                              : fmt::format("reading {}: {} MB", name, done >> 20U));
  };
}

}  // namespace waymark
