#include <waymark/formats/text_file.hpp>

#include <cerrno>
#include <climits>
#include <cstdlib>
#include <memory>
#include <optional>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <waymark/core/error.hpp>

namespace waymark {
namespace {

constexpr std::size_t kChunk = 1U << 20U;
constexpr int kAttempts = 1000;

std::string reason(int error) {
  return std::generic_category().message(error);
}

[[noreturn]] void fail_read(const std::string& path, int error) {
  throw InputError(fmt::format("{}: cannot read: {}", path, reason(error)));
}

[[noreturn]] void fail_write(const std::string& path, int error) {
  if (error == ENOENT) throw OutputError(fmt::format("{}: cannot write: its folder does not exist", path));
  throw OutputError(fmt::format("{}: cannot write: {}", path, reason(error)));
}

/// An open file that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  [[nodiscard]] int number() const { return number_; }
  /// @return 0, or the error: a full network disk may say so only here.
  [[nodiscard]] int close() {
    const int result = ::close(number_);
    number_ = -1;
    return result == 0 ? 0 : errno;
  }

 private:
  int number_;
};

/// @return 0, or the error.
int write_all(int descriptor, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(descriptor, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

void write_directly(const std::string& path, std::string_view content) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (file.number() < 0) fail_write(path, errno);
  if (const int error = write_all(file.number(), content); error != 0) fail_write(path, error);
  if (const int error = file.close(); error != 0) fail_write(path, error);
}

/// The file that a chain of symbolic links ends at; the path itself where there is none.
std::string link_target(const std::string& path) {
  const std::unique_ptr<char, decltype(&std::free)> resolved(::realpath(path.c_str(), nullptr), &std::free);
  return resolved ? std::string(resolved.get()) : path;
}

struct PartialFile {
  std::string path;
  int descriptor = -1;
};

PartialFile open_partial(const std::string& path, const std::string& target) {
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    std::string partial = fmt::format("{}.partial-{}-{}", target, ::getpid(), attempt);
    const int descriptor = ::open(partial.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0) return {std::move(partial), descriptor};
    if (errno != EEXIST) fail_write(path, errno);
  }
  fail_write(path, EEXIST);
}

void write_aside(const std::string& path, std::string_view content, std::optional<mode_t> mode) {
  const std::string target = mode ? link_target(path) : path;
  const PartialFile partial = open_partial(path, target);
  Descriptor file(partial.descriptor);
  int error = 0;
  if (mode && ::fchmod(file.number(), *mode) != 0) error = errno;
  if (error == 0) error = write_all(file.number(), content);
  if (const int at_close = file.close(); error == 0) error = at_close;
  if (error == 0 && ::rename(partial.path.c_str(), target.c_str()) != 0) error = errno;
  if (error == 0) return;
  ::unlink(partial.path.c_str());
  fail_write(path, error);
}

}  // namespace

std::string read_text_file(const std::string& path) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.number() < 0) fail_read(path, errno);
  struct stat status {};
  if (::fstat(file.number(), &status) != 0) fail_read(path, errno);
  if (S_ISDIR(status.st_mode)) fail_read(path, EISDIR);

  std::string content;
  const std::size_t expected = S_ISREG(status.st_mode) ? static_cast<std::size_t>(status.st_size) : 0;
  std::size_t used = 0;
  while (true) {
    content.resize(used < expected ? expected + 1 : used + kChunk);  // one byte more sees the end at once
    const ssize_t count = ::read(file.number(), content.data() + used, content.size() - used);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail_read(path, errno);
    if (count == 0) break;
    used += static_cast<std::size_t>(count);
  }
  content.resize(used);
  return content;
}

void write_file_atomically(const std::string& path, std::string_view content) {
  if (path == "-" || path == "/dev/stdout") {
    if (const int error = write_all(STDOUT_FILENO, content); error != 0)
      fail_write(path == "-" ? "standard output" : path, error);
    return;
  }
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    if (errno != ENOENT) fail_write(path, errno);
    return write_aside(path, content, std::nullopt);
  }
  if (S_ISDIR(status.st_mode)) fail_write(path, EISDIR);
  if (!S_ISREG(status.st_mode)) return write_directly(path, content);
  // Through /dev/fd/N and the like a regular file is open already; putting another in its place would miss
  // it.
  if (path.starts_with("/dev/") || path.starts_with("/proc/")) return write_directly(path, content);
  write_aside(path, content, status.st_mode & 07777);
}

}  // namespace waymark
