/// Finds frames of the UBX protocol (u-blox) in streams that hold other data too.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// A message: B5 62, class, id, length (2 bytes, little-endian), payload, checksum (2 bytes:
/// Fletcher's, 8 bits, over class to payload).
struct UbxFrame {
  std::uint16_t key = 0;     ///< class * 256 + id
  std::string_view payload;  ///< valid while the bytes are
};

/// No message is longer; a greater length is a corrupt one.
inline constexpr std::size_t kLongestUbxPayload = 8192;

/// The next thing found in a stretch of bytes.
struct UbxFound {
  enum class Kind {
    nothing,    ///< no frame begins in the rest
    frame,      ///< a frame with a right checksum
    broken,     ///< the beginning of a frame of a known class with a wrong length or checksum
    incomplete  ///< a frame may begin at `begin`; `missing` more bytes are needed to tell
  };
  Kind kind = Kind::nothing;
  std::size_t begin = 0;
  /// where to continue: after a frame, or after the two sync bytes of a broken one
  std::size_t end = 0;
  std::size_t missing = 0;
  UbxFrame frame;  ///< of a broken one only the key
};

/// The bytes in which frames are searched. A log may be full of false headers, each with a great
/// length; then the same bytes would be summed again for each of them. After the equivalent of four
/// passes, running sums are kept.
class UbxStretch {
 public:
  /// @param bytes must outlive this object
  explicit UbxStretch(std::string_view bytes) : bytes_(bytes) {}
  [[nodiscard]] std::string_view bytes() const { return bytes_; }
  /// Checks the checksum of a frame with this size that begins at `begin`.
  [[nodiscard]] bool checksum_is_right(std::size_t begin, std::size_t size);

 private:
  struct Sums {
    std::uint8_t a = 0;
    std::uint8_t b = 0;
  };
  void make_sums();

  std::string_view bytes_;
  std::size_t summed_ = 0;
  std::vector<Sums> sums_;  ///< sums over the bytes before each place
};

/// Returns the first frame or broken frame at `from` or later, and skips the bytes before it. Other
/// binary data contains sync bytes by chance. They are skipped too if the class is unknown and the
/// checksum is wrong.
[[nodiscard]] UbxFound find_ubx_frame(UbxStretch& stretch, std::size_t from);

/// Returns "NAV-PVT", or "UBX-0x01-0x99" for a message without a name here.
[[nodiscard]] std::string ubx_name(std::uint16_t key);

/// The base of decoders that work frame by frame. A broken frame is a corrupt record. The search
/// continues right after its sync bytes, so a corrupt length hides nothing.
class UbxFrameDecoder : public LogDecoder {
 public:
  /// @param path name of the log, for messages
  UbxFrameDecoder(std::string path, LogRequest request)
      : path_(std::move(path)), request_(std::move(request)) {}
  void take(std::string_view piece) final;
  /// Also fills `kinds`.
  void finish() final;

 protected:
  /// Takes bytes that belong to no frame, in order and in pieces of any size.
  virtual void take_strange([[maybe_unused]] std::string_view bytes) {}
  virtual void take_frame(const UbxFrame& frame) = 0;
  /// Called after the last frame.
  virtual void end() {}

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const LogRequest& request() const { return request_; }
  /// Number of the current frame in the log, from 1, and its place.
  [[nodiscard]] std::size_t number() const { return number_; }
  [[nodiscard]] std::uint64_t byte() const { return byte_; }
  [[nodiscard]] std::size_t count(std::uint16_t key) const;
  /// Counts a corrupt record, with the message "path:byte N: what" (N from 0).
  void corrupt(std::uint64_t byte, const std::string& what);
  /// Adds a note that begins with the name of the log.
  void note(const std::string& text) { data_.notes.push_back(path_ + ": " + text); }

 private:
  std::size_t scan(std::string_view bytes, bool at_end);
  void give(const UbxFrame& frame, std::uint64_t place);
  void give_broken(const UbxFound& found, std::string_view bytes);

  std::string path_;
  LogRequest request_;
  std::string begun_;        ///< bytes from the place where a frame may begin
  std::size_t missing_ = 0;  ///< how many more bytes are needed to judge begun_
  std::uint64_t base_ = 0;   ///< place in the log of the bytes that are searched
  void pass_over(std::string_view bytes);

  std::uint64_t strange_ = 0;
  std::size_t number_ = 0;
  std::uint64_t byte_ = 0;
  using CountsById = std::array<std::size_t, 256>;
  /// by class; null: the class has not occurred
  std::array<std::unique_ptr<CountsById>, 256> counts_;
};

}  // namespace waymark::formats
