#include <waymark/formats/logs/detail/compression/byte_source.hpp>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace waymark::formats {
namespace {

constexpr std::size_t kInput = 64U << 10U;

}  // namespace

ByteSource::ByteSource(std::string path) : file_(std::move(path), PipeUse::remember), input_(kInput) {
  // A pipe may give its first bytes one by one.
  std::size_t known = 0;
  while (known < kLongestMagic && !at_end_) known += read_some(std::span(input_).subspan(known));
  waiting_ = std::span<const char>(input_).first(known);
  codec_ = codec_of({waiting_.data(), waiting_.size()});
}

std::string_view ByteSource::next(std::vector<char>& buffer) {
  const std::size_t count = codec_ ? uncompress(buffer) : copy(buffer);
  return {buffer.data(), count};
}

/// Reads what the file has at the moment. At its end it sets at_end_ and returns 0.
std::size_t ByteSource::read_some(std::span<char> buffer) {
  const std::size_t count = file_.read(buffer);
  at_end_ = count == 0;
  done_ += count;
  return count;
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
