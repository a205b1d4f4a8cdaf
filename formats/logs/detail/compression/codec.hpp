/// Uncompresses the bytes of gzip, xz and Zstandard, and of chunks in LZ4 and bzip2.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>

namespace waymark::formats {

/// The longest sign of a compression in the first bytes of a file.
inline constexpr std::size_t kLongestMagic = 6;

/// The state of one compressed file.
class Codec {
 public:
  enum class Outcome {
    more,     ///< input is used up, or the output is full
    end,      ///< the content ends here
    damaged,  ///< see what()
  };

  virtual ~Codec() = default;
  /// Uncompresses until the input is used up or the output is full, and takes both off the spans.
  /// @param last no input follows
  [[nodiscard]] virtual Outcome step(std::span<const char>& in, std::span<char>& out, bool last) = 0;
  /// The words of the library for damage.
  [[nodiscard]] virtual std::string_view what() const = 0;
};

/// Returns the codec for the first bytes of a file. Null: the file is not compressed.
[[nodiscard]] std::unique_ptr<Codec> codec_of(std::string_view head);

/// @name For chunks within a file, whose compression the file names
///@{
[[nodiscard]] std::unique_ptr<Codec> zstd_codec();
/// Null: the build does not have it.
[[nodiscard]] std::unique_ptr<Codec> bzip2_codec();
/// Frames of LZ4. Null: the build does not have it.
[[nodiscard]] std::unique_ptr<Codec> lz4_codec();
///@}

}  // namespace waymark::formats
