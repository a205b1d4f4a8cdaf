#include <waymark/tools/benchmark/process_memory.hpp>

#include <malloc.h>

#include <fstream>
#include <string>

namespace waymark::benchmark {
namespace {

/// Reads a line "NAME:   1234 kB" of /proc/self/status.
std::optional<double> status_megabytes(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double kibibytes = 0;
    if (word == name + ":" && status >> kibibytes) return 1024 * kibibytes / 1e6;
  }
  return std::nullopt;
}

}  // namespace

std::optional<double> resident_megabytes() {
  return status_megabytes("VmRSS");
}

std::optional<double> restart_peak_memory() {
  malloc_trim(0);
  std::ofstream clear("/proc/self/clear_refs");
  clear << 5 << std::flush;  // proc(5): resets the peak resident set size
  if (!clear) return std::nullopt;
  return resident_megabytes();
}

std::optional<double> peak_megabytes() {
  return status_megabytes("VmHWM");
}

}  // namespace waymark::benchmark
