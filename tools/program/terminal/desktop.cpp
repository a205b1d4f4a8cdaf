#include <waymark/tools/program/terminal/desktop.hpp>

#include <chrono>
#include <cstdlib>
#include <thread>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace waymark::program {
namespace {

constexpr std::chrono::milliseconds kStep{50};
constexpr std::chrono::seconds kPatience{3};

bool is_set(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr && *value != '\0';
}

/// Starts a program without terminal. Returns its process, -1 if it cannot be started.
pid_t start(const char* program, const std::string& argument) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_RDWR, 0);
  std::string name = program;
  std::string word = argument;
  char* const words[] = {name.data(), word.data(), nullptr};
  pid_t process = -1;
  const int failed = posix_spawnp(&process, program, &actions, nullptr, words, environ);
  posix_spawn_file_actions_destroy(&actions);
  return failed != 0 ? -1 : process;
}

}  // namespace

bool open_on_desktop(const std::string& path) {
  if (!is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY")) return false;
  const pid_t process = start("xdg-open", path);
  if (process < 0) return false;
  const auto end = std::chrono::steady_clock::now() + kPatience;
  int status = 0;
  while (::waitpid(process, &status, WNOHANG) == 0) {
    // It may have become the browser itself, which goes on as long as the window is open.
    if (std::chrono::steady_clock::now() > end) return true;
    std::this_thread::sleep_for(kStep);
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace waymark::program
