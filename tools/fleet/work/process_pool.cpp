#include <waymark/tools/fleet/work/process_pool.hpp>

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>

#include <waymark/core/base/detail/address_sanitizer.hpp>
#include <waymark/core/base/error.hpp>

namespace waymark::fleet {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kCannotStart = 127;    // as a shell says it
constexpr int kLookAround_ms = 200;  // a stop that comes just before the wait is seen then

struct Running {
  std::size_t number = 0;
  pid_t pid = 0;
  int watch = -1;  ///< readable once the process has ended
  Clock::time_point begin;
  double time_limit_s = 0;
  bool out_of_time = false;
};

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Sends a stream into a file. Called in the child.
bool redirect(const std::string& file, int stream) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  return descriptor >= 0 && ::dup2(descriptor, stream) >= 0;
}

/// Becomes the program. Called in the child, where nothing may be allocated or thrown.
[[noreturn]] void become(const Process& process, char* const* words, pid_t parent) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(kCannotStart);  // it died before the line above
  if (process.memory_bytes > 0 && !detail::kAddressSanitized) {
    const rlimit limit{process.memory_bytes, process.memory_bytes};
    ::setrlimit(RLIMIT_DATA, &limit);
  }
  const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  if (nothing < 0 || ::dup2(nothing, STDIN_FILENO) < 0) ::_exit(kCannotStart);
  if (!redirect(process.output_file, STDOUT_FILENO) || !redirect(process.messages_file, STDERR_FILENO))
    ::_exit(kCannotStart);
  ::execv(words[0], words);
  ::_exit(kCannotStart);
}

Running start(const Process& process, std::size_t number) {
  std::vector<char*> words;
  for (const std::string& word : process.words) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  const pid_t parent = ::getpid();
  const pid_t pid = ::fork();
  if (pid == 0) become(process, words.data(), parent);
  if (pid < 0) throw OutputError(std::string("cannot start a process: ") + std::strerror(errno));
  ::setpgid(pid, pid);  // whoever comes first
  // glibc 2.36 declares its own function for C only
  const int watch = static_cast<int>(::syscall(SYS_pidfd_open, pid, 0));
  if (watch < 0) {
    const int reason = errno;
    ::kill(pid, SIGKILL);
    ::waitpid(pid, nullptr, 0);
    throw OutputError(std::string("cannot watch a process: ") + std::strerror(reason));
  }
  return {number, pid, watch, Clock::now(), process.time_limit_s};
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// Takes leave of a process that has ended.
ProcessEnd leave(const Running& process) {
  int status = 0;
  rusage used{};
  ::wait4(process.pid, &status, 0, &used);
  ::close(process.watch);
  ProcessEnd end;
  end.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
  end.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  end.out_of_time = process.out_of_time && end.signal == SIGKILL;  // it may have ended just before
  end.wall_s = seconds_since(process.begin);
  end.processor_s = seconds(used.ru_utime) + seconds(used.ru_stime);
  end.memory_bytes = static_cast<std::uint64_t>(used.ru_maxrss) * 1024;
  return end;
}

/// The processes that run now. Whatever happens, none of them outlives it.
class Pool {
 public:
  Pool() = default;
  ~Pool() {
    for (const Running& process : running_) ::kill(-process.pid, SIGKILL);
    for (const Running& process : running_) (void)leave(process);
  }
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  [[nodiscard]] std::size_t size() const { return running_.size(); }
  void add(const Process& process) {
    running_.reserve(running_.size() + 1);  // what is started must be kept
    running_.push_back(start(process, started_));
    ++started_;
  }

  /// Waits a while for processes to end, and tells of those that have. Kills those that are out of time.
  void wait(const OnProcessEnd& ended) {
    for (Running& process : running_) {
      if (process.time_limit_s <= 0 || seconds_since(process.begin) < process.time_limit_s) continue;
      process.out_of_time = true;
      ::kill(-process.pid, SIGKILL);
    }
    std::vector<pollfd> watched;
    for (const Running& process : running_) watched.push_back({process.watch, POLLIN, 0});
    if (::poll(watched.data(), watched.size(), kLookAround_ms) <= 0) return;  // also a signal
    for (std::size_t i = watched.size(); i-- > 0;) {
      if (watched[i].revents == 0) continue;
      const Running process = running_[i];
      running_.erase(running_.begin() + static_cast<std::ptrdiff_t>(i));
      ended(process.number, leave(process));
    }
  }

 private:
  std::vector<Running> running_;
  std::size_t started_ = 0;
};

/// Returns the number after a word in a file such as /proc/meminfo; nothing if it is not there.
std::optional<std::uint64_t> number_after(const char* file, const std::string& wanted) {
  std::ifstream in(file);
  std::uint64_t number = 0;
  if (wanted.empty()) return in >> number ? std::optional(number) : std::nullopt;
  for (std::string word; in >> word;)
    if (word == wanted && in >> number) return number;
  return std::nullopt;
}

}  // namespace

bool run_processes(const std::function<std::optional<Process>()>& next, std::size_t at_once,
                   const std::atomic<bool>& stop, const OnProcessEnd& ended) {
  Pool pool;
  bool more = true;
  while (!stop) {
    while (more && !stop && pool.size() < std::max<std::size_t>(1, at_once)) {
      const std::optional<Process> process = next();
      more = process.has_value();
      if (more) pool.add(*process);
    }
    if (pool.size() == 0) return !stop;
    pool.wait(ended);
  }
  return false;
}

std::size_t usable_processors() {
  cpu_set_t usable;
  CPU_ZERO(&usable);
  if (::sched_getaffinity(0, sizeof usable, &usable) != 0) return 1;
  return static_cast<std::size_t>(std::max(1, CPU_COUNT(&usable)));
}

std::uint64_t available_memory() {
  const std::uint64_t kilobytes = number_after("/proc/meminfo", "MemAvailable:").value_or(0);
  const auto group_limit = number_after("/sys/fs/cgroup/memory.max", "");
  return std::min(kilobytes * 1024, group_limit.value_or(kilobytes * 1024));
}

}  // namespace waymark::fleet
