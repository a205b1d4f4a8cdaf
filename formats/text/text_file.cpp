#include <waymark/formats/text/text_file.hpp>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/detail/input_file.hpp>

namespace waymark::formats {
namespace {

constexpr std::size_t kChunk = 1U << 20U;
constexpr std::size_t kLongLine = 64U << 20U;
constexpr int kAttempts = 100;

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

/// Opens a device, or a pipe once it has a reader. A signal that the program handles ends the wait;
/// open() itself would begin to wait again.
int open_to_write(const std::string& path) {
  while (true) {
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor >= 0) {
      if (::fcntl(descriptor, F_SETFL, O_WRONLY) != 0) fail_write(path, errno);
      return descriptor;
    }
    constexpr int kPause_ms = 20;
    if (errno != ENXIO || ::poll(nullptr, 0, kPause_ms) < 0) fail_write(path, errno);
  }
}

void write_directly(const std::string& path, const Producer& produce) {
  Descriptor file(open_to_write(path));
  produce(sink_to(file.number(), path));
  if (const int error = file.close(); error != 0) fail_write(path, error);
}

/// Returns the file at the end of a chain of symbolic links, or the path itself if it is no link.
std::string link_target(const std::string& path) {
  const std::unique_ptr<char, decltype(&std::free)> resolved(::realpath(path.c_str(), nullptr), &std::free);
  return resolved ? std::string(resolved.get()) : path;
}

/// Returns a name beside `target` that nobody can foresee, so that nothing can be laid there.
std::string name_beside(const std::filesystem::path& target) {
  constexpr std::size_t kLongest = 200;  // a name has at most 255 bytes
  std::uint64_t number = 0;
  if (::getrandom(&number, sizeof number, 0) != sizeof number) number = std::random_device()();
  const std::string name =
      fmt::format("{}.partial-{:016x}", target.filename().string().substr(0, kLongest), number);
  return (target.parent_path() / name).string();
}

/// A file under another name beside its final place. The destructor removes it, unless it was
/// moved there.
class PartialFile {
 public:
  /// @param mode of the final file; nobody else may ever open this one
  PartialFile(const std::string& path, const std::string& target, mode_t mode) : path_(path) {
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      name_ = name_beside(target);
      const int flags = O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
      const int descriptor = ::open(name_.c_str(), flags, mode);
      if (descriptor >= 0) {
        file_.emplace(descriptor);
        return;
      }
      if (errno != EEXIST) break;
    }
    const int error = errno;
    name_.clear();
    fail_write(path, error);
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

/// @throws InputError for a zero byte or an endless line in the beginning of a long or endless input
void require_text_if_long(std::string_view content, const InputFile& file) {
  if (file.size().value_or(kLongLine) < kLongLine && content.size() < kLongLine) return;
  if (const std::size_t zero = content.substr(0, kChunk).find('\0'); zero != std::string_view::npos)
    throw InputError(fmt::format("{}: is no text: byte {} is zero", file.path(), zero + 1));
  if (content.size() >= kLongLine && content.substr(0, kLongLine).find('\n') == std::string_view::npos)
    throw InputError(fmt::format("{}:1: is no text: the line does not end within 64 MiB", file.path()));
}

void write_aside(const std::string& path, const Producer& produce, std::optional<mode_t> mode) {
  const std::string target = mode ? link_target(path) : path;
  PartialFile partial(path, target, mode.value_or(0666) & 0777);
  if (mode && ::fchmod(partial.number(), *mode) != 0) fail_write(path, errno);
  produce(sink_to(partial.number(), path));
  partial.put_at(target);
}

}  // namespace

std::string read_text_file(const std::string& path, const TextLimits& limits) {
  InputFile file(path);
  std::string content;
  std::size_t used = 0;
  std::size_t checked = 0;
  while (true) {
    // What a file or stream promises is believed only after its first piece.
    if (used == content.size()) {
      const std::size_t promised = used > 0 ? file.size().value_or(0) + 1 : 0;
      content.resize(std::max({used + used / 2, used + kChunk, promised}));
    }
    const std::size_t count = file.read(std::span(content).subspan(used));
    if (count == 0) break;
    used += count;
    require_text_if_long({content.data(), used}, file);
    if (used > limits.most_bytes)
      throw InputError(fmt::format("{}: is longer than {} MiB, and {} is not: is it the right file?", path,
                                   limits.most_bytes / kChunk, limits.longest));
    for (; limits.check && !file.size() && used - checked >= kChunk; checked += kChunk)
      limits.check(std::string_view(content).substr(checked, kChunk));
  }
  content.resize(used);
  return content;
}

std::function<void(std::string_view)> require_digits(const std::string& path) {
  return [path](std::string_view piece) {
    if (piece.find_first_of("0123456789") == std::string_view::npos)
      throw InputError(path + ": a MiB of it holds no number; the input ends nowhere, or is of another kind");
  };
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

void try_to_write_in(const std::string& folder) {
  PartialFile file(folder, (std::filesystem::path(folder) / "trial").string(), 0600);
  if (const int error = write_all(file.number(), "a trial\n"); error != 0) fail_write(folder, error);
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
