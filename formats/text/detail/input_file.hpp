/// A file, pipe or device that is read from its beginning to its end.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace waymark::formats {

/// @param error  the value of errno
/// @throws InputError always; the message names the path and the reason
[[noreturn]] void fail_read(const std::string& path, int error);

/// Who reads a pipe, and how often. The bytes of a pipe come once.
enum class PipeUse {
  once,      ///< nobody reads it again
  remember,  ///< its bytes are kept in a temporary file, and whoever opens it later reads them from there first
};

/// Reads a file in pieces. A signal that the program handles ends the wait for a pipe: for its
/// writer, and for its bytes.
class InputFile {
 public:
  /// @throws InputError if it cannot be opened, or is a folder
  explicit InputFile(std::string path, PipeUse use = PipeUse::once);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  /// Returns the size of a regular file; nothing for pipes and devices.
  [[nodiscard]] std::optional<std::size_t> size() const { return size_; }
  [[nodiscard]] const std::string& path() const { return path_; }

  /// Reads the bytes that are there, at least one and at most those that fit.
  /// @return 0 at the end of the file
  /// @throws InputError if reading fails, or a signal arrives before the first byte
  [[nodiscard]] std::size_t read(std::span<char> buffer);

 private:
  class Pipe;
  [[nodiscard]] std::size_t read_new(std::span<char> buffer);

  std::string path_;
  int descriptor_ = -1;
  std::shared_ptr<Pipe> pipe_;  ///< of a pipe whose bytes are remembered; the descriptor is then its own
  std::size_t offset_ = 0;      ///< in what the pipe remembers
  std::optional<std::size_t> size_;
};

}  // namespace waymark::formats
