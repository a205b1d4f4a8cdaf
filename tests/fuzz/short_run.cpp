// A short run of every target without libFuzzer:
//   waymark_fuzz_short SEEDS INPUTS SECONDS
// reads the seeds of all targets (make_seeds.py) and tries INPUTS mutations of them for each target, the same ones in
// every run, for SECONDS at most. A finding ends the program; its input lies in found-TARGET in the present folder.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include "targets.hpp"

namespace {

using Clock = std::chrono::steady_clock;
using Bytes = std::string;

constexpr std::size_t kLongest = 8192;

/// What is tried now, for the handler of the signal.
Bytes present;
std::string present_file;

extern "C" void keep_finding(int signal) {
  const int file = ::open(present_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (file >= 0) (void)!::write(file, present.data(), present.size());
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

std::vector<Bytes> seeds_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<Bytes> seeds;
  for (const auto& path : files) {
    std::ifstream file(path, std::ios::binary);
    seeds.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    if (seeds.back().size() > kLongest) seeds.back().resize(kLongest);
  }
  return seeds;
}

class Mutator {
 public:
  explicit Mutator(const std::vector<Bytes>& seeds) : seeds_(seeds) {}

  Bytes next() {
    Bytes text = seeds_[below(seeds_.size())];
    for (std::size_t left = 1 + below(4); left > 0; --left) change(text);
    if (text.size() > kLongest) text.resize(kLongest);
    return text;
  }

 private:
  std::size_t below(std::size_t count) { return count == 0 ? 0 : random_() % count; }

  void change(Bytes& text) {
    static const std::vector<Bytes> kWords = {"0",       "-1",         "1e999",
                                              "nan",     "inf",        "5e-324",
                                              "1e308",   "\n",         " ",
                                              "\x1b[2J", "[",          "{",
                                              "}",       "]",          "\"",
                                              "&a",      "*a",         "---\n",
                                              ": ",      "2147483648", "#",
                                              ",",       ";",          Bytes(1, '\0'),
                                              "-0.0",    "\xff",       "18446744073709551616",
                                              "1e-300"};
    const std::size_t at = below(text.size() + 1);
    const std::size_t length = std::min(1 + below(16), text.size() - std::min(at, text.size()));
    switch (below(6)) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(random_());
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, text.substr(below(text.size() + 1), 1 + below(64)));
        break;
      case 3:
        text.insert(at, kWords[below(kWords.size())]);
        break;
      case 4:
        text.replace(at, length, kWords[below(kWords.size())]);
        break;
      default: {
        const Bytes& other = seeds_[below(seeds_.size())];
        text = text.substr(0, at) + other.substr(std::min(at, other.size()));
      }
    }
  }

  const std::vector<Bytes>& seeds_;
  std::mt19937_64 random_{20240229};
};

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) return 2;
  const long inputs = std::atol(arguments[2]);
  const double seconds = std::atof(arguments[3]);
  for (const int signal : {SIGABRT, SIGSEGV, SIGFPE, SIGBUS, SIGILL}) std::signal(signal, keep_finding);
  int without_seeds = 0;
  for (const waymark_fuzz::Target& target : waymark_fuzz::targets()) {
    const std::vector<Bytes> seeds = seeds_in(std::filesystem::path(arguments[1]) / target.name);
    if (seeds.empty()) {
      std::printf("%s: has no seeds\n", std::string(target.name).c_str());
      ++without_seeds;
      continue;
    }
    present_file = "found-" + std::string(target.name);
    Mutator mutator(seeds);
    const Clock::time_point begin = Clock::now();
    long tried = 0;
    while (tried < inputs && std::chrono::duration<double>(Clock::now() - begin).count() < seconds) {
      present = static_cast<std::size_t>(tried) < seeds.size() ? seeds[static_cast<std::size_t>(tried)]
                                                               : mutator.next();
      target.run(target.name, reinterpret_cast<const std::uint8_t*>(present.data()), present.size());
      ++tried;
    }
    std::printf("%-14s %7ld inputs\n", std::string(target.name).c_str(), tried);
    std::fflush(stdout);
  }
  return without_seeds == 0 ? 0 : 1;
}
