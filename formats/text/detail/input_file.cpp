#include <waymark/formats/text/detail/input_file.hpp>

#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <waymark/core/base/error.hpp>

namespace waymark::formats {

void fail_read(const std::string& path, int error) {
  throw InputError(fmt::format("{}: cannot read: {}", path, std::generic_category().message(error)));
}

// open() of a pipe without a writer would wait, and begin to wait again after every signal.
InputFile::InputFile(std::string path) : path_(std::move(path)) {
  descriptor_ = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor_ < 0) fail_read(path_, errno);
  struct stat status {};
  const int error = ::fstat(descriptor_, &status) != 0 ? errno : S_ISDIR(status.st_mode) ? EISDIR : 0;
  if (error != 0) {
    ::close(descriptor_);
    fail_read(path_, error);
  }
  if (S_ISREG(status.st_mode)) size_ = static_cast<std::size_t>(status.st_size);
}

InputFile::~InputFile() {
  ::close(descriptor_);
}

std::size_t InputFile::read(std::span<char> buffer) {
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
