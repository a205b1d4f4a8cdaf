/// Runs programs beside each other, each in a process of its own: a crash or a lack of memory ends
/// one of them and no other.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace waymark::fleet {

struct Process {
  std::vector<std::string> words;  ///< the program's file, then its arguments
  std::string output_file;         ///< for its standard output
  std::string messages_file;       ///< for its standard error
  std::uint64_t memory_bytes = 0;  ///< of data that it may have (RLIMIT_DATA); 0: no limit
  double time_limit_s = 0;         ///< it is killed with its own children after this; 0: no limit
};

struct ProcessEnd {
  int exit_code = 0;
  int signal = 0;            ///< that ended it; 0: none
  bool out_of_time = false;  ///< killed, because it reached its time limit
  double wall_s = 0;
  double processor_s = 0;          ///< user and system
  std::uint64_t memory_bytes = 0;  ///< largest resident set
};

/// Called for each process that ended, with its number in the order of their starts.
using OnProcessEnd = std::function<void(std::size_t number, const ProcessEnd& end)>;

/// Runs the processes that `next` gives, at most `at_once` at a time, until it gives none and all have
/// ended. If `stop` becomes true, or a callback throws, all that run are killed (SIGKILL) with their
/// own children, and `ended` is not called for them. If this process itself is killed, the system kills
/// them. Each has a process group of its own, so that Ctrl-C on a terminal reaches only the caller.
/// @return false if it was stopped
/// @throws OutputError if a process cannot be started
bool run_processes(const std::function<std::optional<Process>()>& next, std::size_t at_once,
                   const std::atomic<bool>& stop, const OnProcessEnd& ended);

/// Returns how many processors this process may use.
[[nodiscard]] std::size_t usable_processors();

/// Returns how much memory may be taken without swapping: what is available (MemAvailable), within the
/// limit of the control group.
[[nodiscard]] std::uint64_t available_memory();

}  // namespace waymark::fleet
