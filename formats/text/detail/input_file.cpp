#include <waymark/formats/text/detail/input_file.hpp>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <map>
#include <mutex>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <waymark/core/base/error.hpp>

namespace waymark::formats {
namespace {

/// What to do instead of naming a folder.
std::string file_of(const std::string& folder) {
  std::error_code unknown;
  const std::filesystem::path drive = std::filesystem::path(folder) / "drive.yaml";
  if (std::filesystem::exists(drive, unknown)) return "; name the file in it: " + drive.string();
  return "; name a file in it";
}

}  // namespace

void fail_read(const std::string& path, int error) {
  throw InputError(fmt::format("{}: cannot read: {}{}", path, std::generic_category().message(error),
                               error == EISDIR ? file_of(path) : ""));
}

/// A pipe that stays open while the program runs, and the bytes that came out of it.
class InputFile::Pipe {
 public:
  Pipe(int descriptor, std::string path)
      : descriptor_(descriptor), path_(std::move(path)), memory_(std::tmpfile()) {
    if (memory_ == nullptr) fail_read(path_, errno);
  }
  ~Pipe() {
    ::close(descriptor_);
    std::fclose(memory_);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  [[nodiscard]] int descriptor() const { return descriptor_; }
  [[nodiscard]] std::size_t kept() const { return kept_; }
  void keep(std::span<const char> bytes) {
    while (!bytes.empty()) {
      const ssize_t count =
          ::pwrite(::fileno(memory_), bytes.data(), bytes.size(), static_cast<off_t>(kept_));
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) fail_read(path_ + ": its copy in a temporary file", count < 0 ? errno : EIO);
      kept_ += static_cast<std::size_t>(count);
      bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
  }
  [[nodiscard]] std::size_t recall(std::size_t offset, std::span<char> buffer) const {
    const std::size_t size = std::min(buffer.size(), kept_ - offset);
    const ssize_t count = ::pread(::fileno(memory_), buffer.data(), size, static_cast<off_t>(offset));
    if (count <= 0) fail_read(path_ + ": its copy in a temporary file", count < 0 ? errno : EIO);
    return static_cast<std::size_t>(count);
  }

  /// Returns the pipe that is open under a descriptor, as it was when it was first opened.
  /// The descriptor is closed with it.
  static std::shared_ptr<Pipe> of(int descriptor, const struct stat& status, const std::string& path) {
    static std::mutex mutex;
    static std::map<std::pair<dev_t, ino_t>, std::shared_ptr<Pipe>> known;
    const std::lock_guard lock(mutex);
    std::shared_ptr<Pipe>& pipe = known[{status.st_dev, status.st_ino}];
    if (pipe == nullptr) {
      pipe = std::make_shared<Pipe>(descriptor, path);
    } else {
      ::close(descriptor);
    }
    return pipe;
  }

 private:
  int descriptor_;
  std::string path_;  // for messages
  std::FILE* memory_;
  std::size_t kept_ = 0;
};

// open() of a pipe without a writer would wait, and begin to wait again after every signal.
InputFile::InputFile(std::string path, PipeUse use) : path_(std::move(path)) {
  descriptor_ = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor_ < 0) fail_read(path_, errno);
  struct stat status {};
  const int error = ::fstat(descriptor_, &status) != 0 ? errno : S_ISDIR(status.st_mode) ? EISDIR : 0;
  if (error != 0) {
    ::close(descriptor_);
    fail_read(path_, error);
  }
  if (S_ISREG(status.st_mode)) size_ = static_cast<std::size_t>(status.st_size);
  if (use == PipeUse::remember && S_ISFIFO(status.st_mode)) {
    pipe_ = Pipe::of(descriptor_, status, path_);
    descriptor_ = pipe_->descriptor();
  }
}

InputFile::~InputFile() {
  if (pipe_ == nullptr) ::close(descriptor_);
}

std::size_t InputFile::read(std::span<char> buffer) {
  if (pipe_ == nullptr) return read_new(buffer);
  if (offset_ == pipe_->kept()) pipe_->keep(buffer.first(read_new(buffer)));
  if (offset_ == pipe_->kept()) return 0;
  const std::size_t count = pipe_->recall(offset_, buffer);
  offset_ += count;
  return count;
}

std::size_t InputFile::read_new(std::span<char> buffer) {
  while (true) {
    if (!size_) {
      pollfd wait{descriptor_, POLLIN, 0};
      if (::poll(&wait, 1, -1) < 0) fail_read(path_, errno);
    }
    const ssize_t count = ::read(descriptor_, buffer.data(), buffer.size());
    if (count >= 0) return static_cast<std::size_t>(count);
    if (errno != EINTR && errno != EAGAIN) fail_read(path_, errno);
  }
}

}  // namespace waymark::formats
