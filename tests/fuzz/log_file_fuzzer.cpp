// Files: as they are, or compressed and then damaged. The first byte: bit 0 compresses, bit 1 cuts the file
// (at the second byte, 256ths), bit 2 flips a bit of it (at the third byte), bits 3 and 4 choose xz or zstd.
#include <array>
#include <vector>

#include <lzma.h>
#include <zlib.h>
#include <zstd.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/log_file.hpp>
#include <waymark/formats/logs/log_readers.hpp>

#include "invariants.hpp"
#include "memory_file.hpp"
#include "targets.hpp"

namespace waymark_fuzz {
namespace {

constexpr std::size_t kHeader = 3;
constexpr std::size_t kLongestSign = 6;  ///< of a compression

std::string xz_of(const std::string& text) {
  std::string result(lzma_stream_buffer_bound(text.size()), '\0');
  std::size_t size = 0;
  if (lzma_easy_buffer_encode(
          0, LZMA_CHECK_CRC32, nullptr, reinterpret_cast<const std::uint8_t*>(text.data()), text.size(),
          reinterpret_cast<std::uint8_t*>(result.data()), &size, result.size()) != LZMA_OK)
    broken("liblzma");
  result.resize(size);
  return result;
}

std::string zstd_of(const std::string& text) {
  std::string result(ZSTD_compressBound(text.size()), '\0');
  result.resize(ZSTD_compress(result.data(), result.size(), text.data(), text.size(), 1));
  return result;
}

std::string gzip_of(const std::string& text) {
  z_stream stream{};
  if (deflateInit2(&stream, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY) != Z_OK) broken("zlib");
  std::string result(deflateBound(&stream, text.size()) + 64, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<unsigned>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(result.data());
  stream.avail_out = static_cast<unsigned>(result.size());
  if (deflate(&stream, Z_FINISH) != Z_STREAM_END) broken("zlib");
  result.resize(stream.total_out);
  deflateEnd(&stream);
  return result;
}

}  // namespace

void fuzz_log_file(std::string_view, const std::uint8_t* bytes, std::size_t size) {
  if (size < kHeader) return;
  const std::string plain(reinterpret_cast<const char*>(bytes) + kHeader, size - kHeader);
  const bool compress = (bytes[0] & 1U) != 0;
  const auto packed = std::array{gzip_of, xz_of, zstd_of, gzip_of}[bytes[0] >> 3U & 3U];
  std::string content = compress ? packed(plain) : plain;
  const bool cut = (bytes[0] & 2U) != 0;
  const bool flip = (bytes[0] & 4U) != 0;
  if (cut) content.resize(content.size() * bytes[1] / 256);
  if (flip && !content.empty()) content[content.size() * bytes[2] / 256] ^= 0x10;

  const MemoryFile file(content);
  try {
    std::string read;
    const std::string trouble =
        waymark::formats::read_in_pieces(file.path(), [&](std::string_view piece) { read += piece; });
    if (compress && !cut && !flip && (read != plain || !trouble.empty()))
      broken("a sound file is not read as it is");
    // A part of the sign is not known for the beginning of a compressed file.
    if (compress && cut && !flip && content.size() >= kLongestSign && read != plain.substr(0, read.size()))
      broken("a cut file gives other bytes");
  } catch (const waymark::InputError& error) {
    broken(error.what());
  }
  try {
    const waymark::formats::Recognised found =
        waymark::formats::recognise_log(file.path(), waymark::formats::builtin_log_readers());
    waymark::LogRequest request;
    request.default_sigma_m = 5;
    check_data(waymark::formats::read_log_file(*found.reader.reader, file.path(), request), request);
  } catch (const waymark::InputError&) {
    // An unreadable log is refused.
  }
}

}  // namespace waymark_fuzz
