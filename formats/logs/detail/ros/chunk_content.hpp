/// The content of a chunk: records that a file keeps compressed. It is uncompressed piece by piece, so that
/// memory does not grow with what a file claims.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/formats/logs/detail/compression/codec.hpp>

namespace waymark::formats {

/// A chunk of more bytes is refused. Recorders write chunks of about 1 MB.
inline constexpr std::uint64_t kLargestChunk = 1ULL << 30U;

class ChunkContent {
 public:
  using Sink = std::function<void(std::string_view)>;
  /// @param size of the uncompressed content as the file tells it, bytes
  /// @param sink takes the uncompressed content
  ChunkContent(std::uint64_t size, Sink sink) : size_(size), sink_(std::move(sink)) {}

  /// Chooses the codec by its name in the file: "" or "none", "lz4", "zstd". @return null, or an error
  [[nodiscard]] const char* open(std::string_view compression);
  /// Takes the next bytes of the chunk. @return null, or an error
  [[nodiscard]] const char* take(std::string_view bytes);
  /// Gives what was held back of a chunk that ends here, or is cut here. @return null, or an error
  [[nodiscard]] const char* flush();
  /// Call this after the last bytes. @param crc32 of the content as the file tells it; 0: not told
  /// @return null, or an error
  [[nodiscard]] const char* finish(std::uint32_t crc32);

 private:
  [[nodiscard]] const char* give(std::string_view content);
  [[nodiscard]] const char* uncompress(std::string_view bytes);

  std::uint64_t size_;
  std::uint64_t done_ = 0;
  std::uint32_t crc_ = 0;
  Sink sink_;
  std::unique_ptr<Codec> codec_;
  /// What a damaged chunk still gives depends on where the codec is called, so it is called at fixed places.
  std::string waiting_;
  std::vector<char> buffer_;
};

}  // namespace waymark::formats
