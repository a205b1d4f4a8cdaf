#include <waymark/formats/logs/detail/ros/chunk_content.hpp>

#include <span>

#include <zlib.h>

namespace waymark::formats {
namespace {

constexpr std::size_t kChunkBuffer = 64U << 10U;

}  // namespace

const char* ChunkContent::open(std::string_view compression) {
  if (size_ > kLargestChunk) return "it claims more than 1 GiB";
  if (compression.empty() || compression == "none") return nullptr;
  if (compression == "zstd") {
    codec_ = zstd_codec();
  } else if (compression == "lz4") {
    codec_ = lz4_codec();
    if (!codec_) return "it is compressed with lz4, which this build does not have (liblz4-dev)";
  } else if (compression == "bz2") {
    codec_ = bzip2_codec();
    if (!codec_) return "it is compressed with bz2, which this build does not have (libbz2-dev)";
  } else {
    return "its compression is not known";
  }
  buffer_.resize(kChunkBuffer);
  return nullptr;
}

const char* ChunkContent::give(std::string_view content) {
  // What it claims to hold is given, wherever the pieces end.
  const bool fits = content.size() <= size_ - done_;
  if (!fits) content = content.substr(0, size_ - done_);
  done_ += content.size();
  crc_ = static_cast<std::uint32_t>(
      ::crc32_z(crc_, reinterpret_cast<const Bytef*>(content.data()), content.size()));
  sink_(content);
  return fits ? nullptr : "it holds more bytes than it claims";
}

const char* ChunkContent::take(std::string_view bytes) {
  if (!codec_) return give(bytes);
  while (!bytes.empty()) {
    const std::string_view part = bytes.substr(0, kChunkBuffer - waiting_.size());
    waiting_ += part;
    bytes.remove_prefix(part.size());
    if (waiting_.size() < kChunkBuffer) return nullptr;
    if (const char* error = flush()) return error;
  }
  return nullptr;
}

const char* ChunkContent::flush() {
  if (waiting_.empty()) return nullptr;
  const char* error = uncompress(waiting_);
  waiting_.clear();
  return error;
}

const char* ChunkContent::uncompress(std::string_view bytes) {
  std::span<const char> in(bytes.data(), bytes.size());
  for (;;) {
    std::span<char> out(buffer_);
    const std::size_t before = in.size();
    const Codec::Outcome outcome = codec_->step(in, out, false);
    const std::size_t made = buffer_.size() - out.size();
    if (made > 0) {
      if (const char* error = give({buffer_.data(), made})) return error;
    }
    if (outcome == Codec::Outcome::damaged) return "its compressed content is damaged";
    if (outcome == Codec::Outcome::end || (made == 0 && (in.empty() || in.size() == before))) return nullptr;
  }
}

const char* ChunkContent::finish(std::uint32_t crc32) {
  if (const char* error = flush()) return error;
  if (done_ != size_) return "it holds fewer bytes than it claims";
  if (crc32 != 0 && crc32 != crc_) return "its checksum is wrong";
  return nullptr;
}

}  // namespace waymark::formats
