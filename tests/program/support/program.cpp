#include "program/support/program.hpp"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include "support/paths.hpp"

namespace {

namespace fs = std::filesystem;

constexpr int kPatience_ms = 240'000;

/// The folder of this process, removed at its end (process ids come again).
struct Scratch {
  fs::path path = [] {
    fs::remove_all(waymark_test::scratch_dir());
    return waymark_test::scratch_dir();
  }();
  ~Scratch() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  int folders = 0;
};

Scratch& scratch() {
  static Scratch instance;
  return instance;
}

[[noreturn]] void become_program(std::vector<std::string>& arguments, const RunOptions& options, int out,
                                 int err) {
  ::dup2(out, STDOUT_FILENO);
  ::dup2(err, STDERR_FILENO);
  if (options.file_size_limit >= 0) {
    const auto bytes = static_cast<rlim_t>(options.file_size_limit);
    const struct rlimit limit { bytes, bytes };
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  std::signal(SIGPIPE, SIG_DFL);
  if (!options.folder.empty() && ::chdir(options.folder.c_str()) != 0) ::_exit(126);
  execute(arguments);
}

}  // namespace

void execute(std::vector<std::string>& arguments) {
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  ::execv(argv[0], argv.data());
  ::_exit(127);
}

bool read_some(int descriptor, std::string& text) {
  std::array<char, 1 << 16> buffer;
  const ssize_t count = ::read(descriptor, buffer.data(), buffer.size());
  if (count > 0) text.append(buffer.data(), static_cast<std::size_t>(count));
  return count > 0;
}

RunResult run(std::vector<std::string> arguments, const RunOptions& options) {
  arguments.insert(arguments.begin(),
                   options.program.empty() ? waymark_test::program_path() : options.program);
  int out[2];
  int err[2];
  if (::pipe2(out, O_CLOEXEC) != 0 || ::pipe2(err, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  int target = out[1];
  if (!options.out_file.empty()) {
    target = ::open(options.out_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (target < 0) throw std::runtime_error("cannot open " + options.out_file);
  }
  if (options.close_output) ::close(out[0]);  // before the program can write
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("cannot fork");
  if (child == 0) {
    become_program(arguments, options, target, err[1]);
  }
  if (target != out[1]) ::close(target);
  ::close(out[1]);
  ::close(err[1]);

  RunResult result;
  bool interrupted = options.interrupt_at.empty();
  std::array<pollfd, 2> streams = {{{options.close_output ? -1 : out[0], POLLIN, 0}, {err[0], POLLIN, 0}}};
  while (streams[0].fd >= 0 || streams[1].fd >= 0) {
    if (::poll(streams.data(), streams.size(), kPatience_ms) == 0) ::kill(child, SIGKILL);
    for (std::size_t i = 0; i < streams.size(); ++i) {
      if (streams[i].fd < 0 || streams[i].revents == 0) continue;
      if (read_some(streams[i].fd, i == 0 ? result.out : result.err)) continue;
      ::close(streams[i].fd);
      streams[i].fd = -1;
    }
    if (!interrupted && result.err.find(options.interrupt_at) != std::string::npos) {
      ::kill(child, SIGINT);
      interrupted = true;
    }
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  return result;
}

void check_refused(const RunResult& result, int code, const std::string& message) {
  INFO(message << "\n" << result.err);
  CHECK(result.code == code);
  CHECK(contains(result.err, "waymark: error: "));
  CHECK(contains(result.err, message));
  CHECK(result.out.empty());
}

std::string fresh_folder() {
  const fs::path folder = scratch().path / std::to_string(++scratch().folders);
  fs::create_directories(folder);
  return folder.string() + "/";
}

std::string write_text(const std::string& path, std::string_view text) {
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

std::string read_text(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

bool exists(const std::string& path) {
  return fs::exists(path);
}

std::vector<std::string> names_in(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}
