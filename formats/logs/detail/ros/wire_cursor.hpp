/// Reads numbers from the bytes of a record. Nothing is read beyond the end: a cursor that ran out stays so.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace waymark::formats {

/// A place in bytes of known order and alignment.
class WireCursor {
 public:
  /// @param most numbers are aligned to their size, but to no more than this; 1: not at all
  explicit WireCursor(std::string_view bytes, bool big_endian = false, std::size_t most = 1)
      : bytes_(bytes), big_endian_(big_endian), most_(most) {}

  /// Returns the next number, or 0 once the bytes are used up.
  template <typename Number>
  Number get() {
    align(sizeof(Number) < most_ ? sizeof(Number) : most_);
    if (!has(sizeof(Number))) return Number{};
    char raw[sizeof(Number)];
    for (std::size_t i = 0; i < sizeof(Number); ++i)
      raw[i] = bytes_[at_ + (big_endian_ == kNativeBig ? i : sizeof(Number) - 1 - i)];
    at_ += sizeof(Number);
    Number number;
    std::memcpy(&number, raw, sizeof number);
    return number;
  }
  /// Returns the next bytes, empty if there are fewer.
  std::string_view take(std::uint64_t size) {
    if (!has(size)) return {};
    const std::string_view taken = bytes_.substr(at_, static_cast<std::size_t>(size));
    at_ += taken.size();
    return taken;
  }
  /// Returns a text behind its length in 4 bytes.
  std::string_view text() { return take(get<std::uint32_t>()); }

  [[nodiscard]] std::string_view rest() const { return bytes_.substr(at_); }
  /// Tells whether all that was asked for was there.
  [[nodiscard]] bool sound() const { return sound_; }

 private:
  static constexpr bool kNativeBig = std::endian::native == std::endian::big;
  bool has(std::uint64_t size) {
    sound_ = sound_ && size <= bytes_.size() - at_;
    return sound_;
  }
  void align(std::size_t size) {
    const std::size_t over = at_ % size;
    if (over != 0) (void)take(size - over);
  }

  std::string_view bytes_;
  bool big_endian_;
  std::size_t most_;
  std::size_t at_ = 0;
  bool sound_ = true;
};

}  // namespace waymark::formats
