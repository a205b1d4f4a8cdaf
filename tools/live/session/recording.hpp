/// The intake of a live run on disk: bytes and when they arrived, so that the run can be repeated to the bit.
#pragma once

#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <string_view>

namespace waymark::live {

/// A piece of bytes. Empty bytes are a pause of the sender.
struct Piece {
  std::uint32_t input = 0;
  std::int64_t arrival_ns = 0;  ///< since 1970, by the clock of this machine
  std::string bytes;
};

class Recorder {
 public:
  /// @throws OutputError
  explicit Recorder(const std::string& path);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;
  /// @returns false if it could not be written; nothing more is recorded then
  bool write(const Piece& piece);
  /// @returns false if the disk does not take it
  bool flush();

 private:
  std::string path_;
  std::FILE* file_ = nullptr;
};

/// Reads a recording. A last piece that is cut is left out.
/// @throws InputError for a file that is none
void read_recording(const std::string& path, const std::function<void(const Piece&)>& take);

}  // namespace waymark::live
