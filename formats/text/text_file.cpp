#include <waymark/formats/text/text_file.hpp>

#include <cerrno>
#include <climits>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/detail/read_failure.hpp>

namespace waymark::formats {
namespace {

constexpr std::size_t kChunk = 1U << 20U;
constexpr int kAttempts = 1000;

using Producer = std::function<void(const TextSink&)>;

std::string reason(int error) {
  return std::generic_category().message(error);
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
  /// @return 0, or the error. A full network disk may report it only here.
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

/// Returns the sink that writes to a descriptor. @throws OutputError with the name `path`
TextSink sink_to(int descriptor, const std::string& path) {
  return [descriptor, path](std::string_view piece) {
    if (const int error = write_all(descriptor, piece); error != 0) fail_write(path, error);
  };
}

void write_directly(const std::string& path, const Producer& produce) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (file.number() < 0) fail_write(path, errno);
  produce(sink_to(file.number(), path));
  if (const int error = file.close(); error != 0) fail_write(path, error);
}

/// Returns the file at the end of a chain of symbolic links, or the path itself if it is no link.
std::string link_target(const std::string& path) {
  const std::unique_ptr<char, decltype(&std::free)> resolved(::realpath(path.c_str(), nullptr), &std::free);
  return resolved ? std::string(resolved.get()) : path;
}

/// A file under another name beside its final place. The destructor removes it, unless it was
/// moved there.
class PartialFile {
 public:
  PartialFile(const std::string& path, const std::string& target) : path_(path) {
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      name_ = fmt::format("{}.partial-{}-{}", target, ::getpid(), attempt);
      const int descriptor = ::open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (descriptor >= 0) {
        file_.emplace(descriptor);
        return;
      }
      if (errno != EEXIST) fail_write(path, errno);
    }
    fail_write(path, EEXIST);
  }
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;
  ~PartialFile() {
    if (!name_.empty()) ::unlink(name_.c_str());
  }

  [[nodiscard]] int number() const { return file_->number(); }
  void put_at(const std::string& target) {
    if (const int error = file_->close(); error != 0) fail_write(path_, error);
    if (::rename(name_.c_str(), target.c_str()) != 0) fail_write(path_, errno);
    name_.clear();
  }

 private:
  const std::string& path_;  // for messages
  std::string name_;
  std::optional<Descriptor> file_;
};

void write_aside(const std::string& path, const Producer& produce, std::optional<mode_t> mode) {
  const std::string target = mode ? link_target(path) : path;
  PartialFile partial(path, target);
  if (mode && ::fchmod(partial.number(), *mode) != 0) fail_write(path, errno);
  produce(sink_to(partial.number(), path));
  partial.put_at(target);
}

}  // namespace

std::string read_text_file(const std::string& path) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.number() < 0) fail_read(path, errno);
  struct stat status {};
  if (::fstat(file.number(), &status) != 0) fail_read(path, errno);
  if (S_ISDIR(status.st_mode)) fail_read(path, EISDIR);

  const std::size_t expected = S_ISREG(status.st_mode) ? static_cast<std::size_t>(status.st_size) : kChunk;
  // one more byte shows the end of the file without growing
  std::string content(expected + 1, '\0');
  std::size_t used = 0;
  while (true) {
    if (used == content.size()) content.resize(used + kChunk);
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
  write_file_atomically(path, [content](const TextSink& sink) { sink(content); });
}

void write_file_atomically(const std::string& path, const Producer& produce) {
  if (path == "-" || path == "/dev/stdout") {
    return produce(sink_to(STDOUT_FILENO, path == "-" ? "standard output" : path));
  }
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    if (errno != ENOENT) fail_write(path, errno);
    return write_aside(path, produce, std::nullopt);
  }
  if (S_ISDIR(status.st_mode)) fail_write(path, EISDIR);
  if (!S_ISREG(status.st_mode)) return write_directly(path, produce);
  // A path like /dev/fd/N may mean an open regular file. A new file in its place would not
  // be that one.
  if (path.starts_with("/dev/") || path.starts_with("/proc/")) return write_directly(path, produce);
  write_aside(path, produce, status.st_mode & 07777);
}

void make_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error && !std::filesystem::is_directory(folder, error)) {
    error = std::make_error_code(std::errc::not_a_directory);
  }
  if (error) throw OutputError(folder + ": cannot make the folder: " + error.message());
}

}  // namespace waymark::formats
