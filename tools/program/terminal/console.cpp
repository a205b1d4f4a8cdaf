#include <sys/ioctl.h>
#include <unistd.h>
#include <csignal>
#include <cstdio>
#include <cstdlib>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/program/terminal/console.hpp>

namespace waymark::program {

std::atomic<bool> interrupted{false};

namespace {

/// Only an impatient user kills: coreutils' `timeout` sends SIGTERM to its child and again to the
/// child's group, and those who supervise a process have SIGKILL.
extern "C" void on_interrupt(int signal) {
  if (interrupted.exchange(true) && signal == SIGINT) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
}

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

/// Tells whether a descriptor is a terminal that understands escape sequences.
bool takes_escapes(int descriptor) {
  const std::string kind = variable("TERM");
  return ::isatty(descriptor) == 1 && !kind.empty() && kind != "dumb";
}

std::size_t columns_of(int descriptor) {
  constexpr std::size_t kUsual = 80;  // of a terminal that does not state its width
  struct winsize size {};
  if (::ioctl(descriptor, TIOCGWINSZ, &size) != 0 || size.ws_col < 2) return kUsual;
  return size.ws_col;
}

/// https://no-color.org: any value but the empty one turns colours off.
text::TextLook look_of(int descriptor) {
  if (::isatty(descriptor) != 1) return {};
  return {takes_escapes(descriptor) && variable("NO_COLOR").empty(), columns_of(descriptor)};
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
    : options_(options), show_progress_(!options.quiet && takes_escapes(STDERR_FILENO)) {}

Console::Console(const CommonOptions& options, Listener listener)
    : options_(options), listener_(std::move(listener)), show_progress_(false) {}

const std::atomic<bool>& Console::cancel() const {
  return listener_ && listener_->cancel != nullptr ? *listener_->cancel : interrupted;
}

void Console::stop_if_cancelled() const {
  if (listener_ && listener_->waits) listener_->waits();
  if (cancel()) throw Interrupted();
}

bool Console::step(const std::string& work, const IterationRecord& record) const {
  if (listener_ && listener_->step) listener_->step(work, record);
  return listener_.has_value();
}

text::TextLook Console::look(bool to_stderr) const {
  if (listener_) return {};
  return look_of(to_stderr ? STDERR_FILENO : STDOUT_FILENO);
}

void Console::result(const std::string& text, bool to_stderr) const {
  if (options_.quiet && !options_.json) return;
  end_progress();
  // JSON escapes what it holds
  const std::string safe = options_.json ? text : text::without_controls(text);
  if (to_stderr) {
    std::fputs(safe.c_str(), stderr);
  } else {
    formats::write_file_atomically("-", safe);
  }
}

void Console::warning(const std::string& text) const {
  if (heard(Listener::Kind::warning, text)) return;
  tell(text::painted("warning:", text::Tone::warning, look(true)) + " " + text);
}

void Console::note(const std::string& text) const {
  if (heard(Listener::Kind::note, text)) return;
  tell(text::painted("note:", text::Tone::dim, look(true)) + " " + text);
}

void Console::tell(const std::string& text) const {
  if (heard(Listener::Kind::detail, text) || options_.quiet) return;
  end_progress();
  std::fprintf(stderr, "%s\n", text::shown_message(text).c_str());
}

void Console::detail(const std::string& text) const {
  if (options_.verbosity > 0) tell(text);
}

bool Console::heard(Listener::Kind kind, const std::string& text) const {
  if (listener_ && listener_->said) listener_->said(kind, text);
  return listener_.has_value();
}

void Console::progress(const std::string& text) const {
  if (listener_ && listener_->progress) listener_->progress(text);
  if (!show_progress_) return;
  // The last column stays free, because a terminal may begin a new line once it is filled.
  const std::size_t columns = columns_of(STDERR_FILENO) - 1;
  std::fprintf(stderr, "\r\033[K%s", text::fitted(text, columns).c_str());
  progress_stands_ = true;
}

void Console::end_progress() const {
  if (progress_stands_) std::fputs("\r\033[K", stderr);
  progress_stands_ = false;
}

std::string error_line(const std::string& message) {
  return "waymark: " + text::painted("error:", text::Tone::error, look_of(STDERR_FILENO)) + " " +
         text::shown_message(message) + "\n";
}

std::function<void(const std::string& file, std::uint64_t done, std::uint64_t size)> watch_reading(
    const Console& console) {
  return [&console, meter = ProgressMeter(), current = std::string(), before = std::uint64_t{0}](
             const std::string& file, std::uint64_t done, std::uint64_t size) mutable {
    console.stop_if_cancelled();
    // A log may be read more than once.
    if (file != current || done < before) meter.restart();
    current = file;
    before = done;
    meter.update(static_cast<double>(done), static_cast<double>(size));
    if (!meter.due()) return;
    console.progress(reading_line(file.substr(file.find_last_of('/') + 1), done, size, meter));
  };
}

StepProgress::StepProgress(const Console& console, std::size_t steps) : console_(console), steps_(steps) {}

void StepProgress::next(const std::string& text) {
  meter_.update(static_cast<double>(step_), static_cast<double>(steps_));
  ++step_;
  line_ = text + remaining_text(meter_);
  console_.progress(line_);
}

}  // namespace waymark::program
