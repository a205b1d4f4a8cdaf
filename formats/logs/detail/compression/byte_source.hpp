/// The bytes of a file, uncompressed. The first bytes of the file tell how it is compressed.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/formats/logs/detail/compression/codec.hpp>
#include <waymark/formats/text/detail/input_file.hpp>

namespace waymark::formats {

/// Reads a file or a pipe from its beginning to its end, once.
class ByteSource {
 public:
  /// @throws InputError if the file cannot be read
  explicit ByteSource(std::string path);
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;

  /// Returns the next bytes, as many as the buffer holds unless it is the end. Empty at the end, and
  /// if a compressed file is cut off or damaged (see trouble()).
  /// @throws InputError if the file cannot be read
  [[nodiscard]] std::string_view next(std::vector<char>& buffer);
  /// The error that stopped the reading of a compressed file; empty: none.
  [[nodiscard]] const std::string& trouble() const { return trouble_; }
  /// Bytes of the file on the disk: read so far, and in all (0: not known).
  [[nodiscard]] std::uint64_t done() const { return done_; }
  [[nodiscard]] std::uint64_t size() const { return file_.size().value_or(0); }

 private:
  [[nodiscard]] std::size_t read_some(std::span<char> buffer);
  [[nodiscard]] std::size_t read_all(std::span<char> buffer);
  [[nodiscard]] std::size_t copy(std::span<char> buffer);
  [[nodiscard]] std::size_t uncompress(std::span<char> buffer);

  InputFile file_;
  std::uint64_t done_ = 0;
  std::vector<char> input_;
  std::span<const char> waiting_;  ///< bytes of the file that are not used yet
  std::unique_ptr<Codec> codec_;   ///< null: the file is not compressed
  bool at_end_ = false;            ///< of the file
  bool ended_ = false;             ///< the codec is done
  std::string trouble_;
};

}  // namespace waymark::formats
