#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>

#include <waymark/core/base/error.hpp>
#include <waymark/core/registry/detail/module_trial.hpp>

namespace waymark {
namespace {

constexpr unsigned kPatience_s = 20;

bool has_one_thread() {
  std::error_code unknown;
  int threads = 0;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task", unknown))
    threads += task.path().empty() ? 0 : 1;
  return !unknown && threads == 1;
}

[[noreturn]] void load_and_end(const std::function<void()>& load) {
  for (const int signal : {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT, SIGALRM, SIGTERM, SIGINT})
    std::signal(signal, SIG_DFL);
  const rlimit none{0, 0};
  ::setrlimit(RLIMIT_CORE, &none);
  const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  ::dup2(nowhere, STDOUT_FILENO);
  ::dup2(nowhere, STDERR_FILENO);
  ::alarm(kPatience_s);
  try {
    load();
  } catch (...) {  // the host will say it
  }
  ::_exit(0);
}

}  // namespace

void try_in_child(const std::string& file, const std::function<void()>& load) {
  if (!has_one_thread()) return;
  const pid_t child = ::fork();
  if (child < 0) return;  // no process to be had: the module is loaded without a trial
  if (child == 0) load_and_end(load);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  if (WIFEXITED(status))  // the dynamic linker gives up so
    throw UsageError(file + ": loading it ends a process with code " + std::to_string(WEXITSTATUS(status)) +
                     ": the file is damaged; build the plugin again");
  const int signal = WTERMSIG(status);
  if (signal == SIGALRM)
    throw UsageError(file + ": loading it takes more than " + std::to_string(kPatience_s) +
                     " s; build the plugin again");
  throw UsageError(file + ": loading it ends a process by signal " + std::to_string(signal) + " (" +
                   strsignal(signal) + "): the file is damaged or its code is wrong; build the plugin again");
}

}  // namespace waymark
