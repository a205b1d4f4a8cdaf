#include "program/support/terminal.hpp"

#include <array>
#include <cstdlib>
#include <regex>
#include <stdexcept>

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include "program/support/help.hpp"
#include "support/paths.hpp"

namespace {

[[noreturn]] void become_program(const Terminal& terminal, std::vector<std::string>& arguments, int out,
                                 int err) {
  ::unsetenv("NO_COLOR");
  for (const auto& [name, value] : terminal.environment) ::setenv(name.c_str(), value.c_str(), 1);
  ::dup2(out, STDOUT_FILENO);
  ::dup2(err, STDERR_FILENO);
  execute(arguments);
}

std::string without_colours(const std::string& text) {
  static const std::regex colours("\033\\[[0-9;]*m");
  return std::regex_replace(text, colours, "");
}

}  // namespace

RunResult run_on(const Terminal& terminal, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), waymark_test::program_path());
  int master = -1;
  int slave = -1;
  struct winsize size {};
  size.ws_row = 24;
  size.ws_col = static_cast<unsigned short>(terminal.columns);
  int out[2];
  if (::openpty(&master, &slave, nullptr, nullptr, &size) != 0 || ::pipe2(out, O_CLOEXEC) != 0)
    throw std::runtime_error("no pseudo terminal");
  ::fcntl(master, F_SETFD, FD_CLOEXEC);
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("cannot fork");
  if (child == 0) become_program(terminal, arguments, terminal.out_in_pipe ? out[1] : slave, slave);
  ::close(slave);
  ::close(out[1]);

  RunResult result;
  std::array<pollfd, 2> streams = {{{out[0], POLLIN, 0}, {master, POLLIN, 0}}};
  while (streams[0].fd >= 0 || streams[1].fd >= 0) {
    if (::poll(streams.data(), streams.size(), 60'000) == 0) ::kill(child, SIGKILL);
    for (std::size_t i = 0; i < streams.size(); ++i) {
      if (streams[i].fd < 0 || streams[i].revents == 0) continue;
      if (read_some(streams[i].fd, i == 0 ? result.out : result.err)) continue;
      ::close(streams[i].fd);
      streams[i].fd = -1;
    }
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  for (std::size_t at = 0; (at = result.err.find("\r\n", at)) != std::string::npos; ++at)
    result.err.erase(at, 1);
  return result;
}

std::vector<std::string> screen_of(const std::string& text) {
  static const std::string kEraseLine = "\033[K";
  std::vector<std::string> lines = lines_of(without_colours(text));
  for (std::string& line : lines) {
    std::string shown;
    std::size_t column = 0;
    for (std::size_t at = 0; at < line.size();) {
      if (line[at] == '\r') {
        column = 0;
        ++at;
      } else if (line.compare(at, kEraseLine.size(), kEraseLine) == 0) {
        shown.resize(std::min(shown.size(), column));
        at += kEraseLine.size();
      } else {
        shown.resize(std::max(shown.size(), column + 1), ' ');
        shown[column++] = line[at++];
      }
    }
    line = shown;
  }
  return lines;
}

std::vector<std::string> shown_in(const std::string& text) {
  static const std::regex erased("\r|\033\\[K");
  return lines_of(std::regex_replace(without_colours(text), erased, "\n"));
}
