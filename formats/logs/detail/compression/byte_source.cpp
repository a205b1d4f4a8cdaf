#include <waymark/formats/logs/detail/compression/byte_source.hpp>

#include <algorithm>
#include <cerrno>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <waymark/formats/text/detail/read_failure.hpp>

namespace waymark::formats {
namespace {

constexpr std::size_t kInput = 64U << 10U;

}  // namespace

ByteSource::ByteSource(std::string path) : path_(std::move(path)), input_(kInput) {
  descriptor_ = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor_ < 0) fail_read(path_, errno);
  struct stat status {};
  if (::fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode))
    size_ = static_cast<std::uint64_t>(status.st_size);
  // A pipe may give its first bytes one by one.
  std::size_t known = 0;
  while (known < kLongestMagic && !at_end_) known += read_some(std::span(input_).subspan(known));
  waiting_ = std::span<const char>(input_).first(known);
  codec_ = codec_of({waiting_.data(), waiting_.size()});
}

ByteSource::~ByteSource() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::string_view ByteSource::next(std::vector<char>& buffer) {
  const std::size_t count = codec_ ? uncompress(buffer) : copy(buffer);
  return {buffer.data(), count};
}

/// Reads what the file has at the moment. At its end it sets at_end_ and returns 0.
std::size_t ByteSource::read_some(std::span<char> buffer) {
  while (true) {
    const ssize_t count = ::read(descriptor_, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      const int error = errno;
      ::close(std::exchange(descriptor_, -1));
      fail_read(path_, error);
    }
    at_end_ = count == 0;
    done_ += static_cast<std::uint64_t>(count);
    return static_cast<std::size_t>(count);
  }
}

std::size_t ByteSource::read_all(std::span<char> buffer) {
  std::size_t filled = 0;
  while (filled < buffer.size() && !at_end_) filled += read_some(buffer.subspan(filled));
  return filled;
}

std::size_t ByteSource::copy(std::span<char> buffer) {
  const std::size_t first = std::min(buffer.size(), waiting_.size());
  std::copy_n(waiting_.begin(), first, buffer.begin());
  waiting_ = waiting_.subspan(first);
  return first + read_all(buffer.subspan(first));
}

std::size_t ByteSource::uncompress(std::span<char> buffer) {
  std::span<char> room = buffer;
  while (!room.empty() && !ended_ && trouble_.empty()) {
    if (waiting_.empty() && !at_end_) waiting_ = std::span<const char>(input_).first(read_some(input_));
    const std::size_t before = waiting_.size() + room.size();
    const Codec::Outcome outcome = codec_->step(waiting_, room, at_end_);
    const bool stuck = before == waiting_.size() + room.size();
    if (outcome == Codec::Outcome::end) {
      ended_ = true;
    } else if (outcome == Codec::Outcome::damaged) {
      trouble_ = fmt::format("the compressed file is damaged ({}); the part before is used", codec_->what());
    } else if (stuck && at_end_) {
      trouble_ = "the compressed file is cut off; the part before is used";
    }
  }
  return buffer.size() - room.size();
}

}  // namespace waymark::formats
