/// UBX messages for tests, made by hand from the interface description.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

namespace waymark_test {

/// A payload that is filled in, little-endian.
class UbxBytes {
 public:
  explicit UbxBytes(std::size_t size) : bytes_(size, '\0') {}
  UbxBytes& put(std::size_t at, std::int64_t value, std::size_t width) {
    for (std::size_t i = 0; i < width; ++i)
      bytes_[at + i] = static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xFFU);
    return *this;
  }
  UbxBytes& u8(std::size_t at, std::int64_t value) { return put(at, value, 1); }
  UbxBytes& u16(std::size_t at, std::int64_t value) { return put(at, value, 2); }
  UbxBytes& u32(std::size_t at, std::int64_t value) { return put(at, value, 4); }
  UbxBytes& f32(std::size_t at, float value) { return put(at, std::bit_cast<std::uint32_t>(value), 4); }
  UbxBytes& f64(std::size_t at, double value) {
    return put(at, static_cast<std::int64_t>(std::bit_cast<std::uint64_t>(value)), 8);
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Returns a frame around a payload. @param key class * 256 + id
inline std::string ubx_frame(unsigned key, std::string_view payload) {
  std::string frame = "\xB5\x62";
  frame += static_cast<char>(key >> 8U);
  frame += static_cast<char>(key & 0xFFU);
  frame += static_cast<char>(payload.size() & 0xFFU);
  frame += static_cast<char>(payload.size() >> 8U);
  frame += payload;
  std::uint8_t a = 0;
  std::uint8_t b = 0;
  for (std::size_t i = 2; i < frame.size(); ++i) {
    a = static_cast<std::uint8_t>(a + static_cast<std::uint8_t>(frame[i]));
    b = static_cast<std::uint8_t>(b + a);
  }
  frame += static_cast<char>(a);
  frame += static_cast<char>(b);
  return frame;
}

/// The GPS time of week of 2023-06-28T14:52:12 UTC (week 2268): 3 days 14:52:12 and 18
/// leap seconds.
inline constexpr std::int64_t kItowMs = ((3 * 24 + 14) * 3600 + 52 * 60 + 12 + 18) * 1000;
/// The same instant in nanoseconds of the POSIX scale: date -u -d 2023-06-28T14:52:12 +%s
inline constexpr std::int64_t kUtc = 1'687'963'932LL * 1'000'000'000;
/// ... and of the GPS scale.
inline constexpr std::int64_t kGps = (2268LL * 604'800'000 + kItowMs) * 1'000'000;

/// Returns NAV-PVT at that instant, plus whole seconds (below 48): a 3D fix at 55.5, 12.25, 30 m
/// above the ellipsoid, hAcc 2 m, 10 m/s (0.5) to 90 degrees (2).
inline UbxBytes nav_pvt(int seconds = 0) {
  UbxBytes pvt(92);
  pvt.u32(0, kItowMs + 1000 * seconds)
      .u16(4, 2023)
      .u8(6, 6)
      .u8(7, 28)
      .u8(8, 14)
      .u8(9, 52)
      .u8(10, 12 + seconds);
  pvt.u8(11, 0x07).u32(16, -250).u8(20, 3).u8(21, 0x01);
  pvt.u32(24, 122'500'000).u32(28, 555'000'000).u32(32, 30'000).u32(36, -9'000).u32(40, 2'000).u32(44, 3'000);
  pvt.u32(60, 10'000).u32(64, 9'000'000).u32(68, 500).u32(72, 200'000);
  return pvt;
}

inline std::string nav_eoe(std::int64_t itow_ms) {
  return ubx_frame(0x0161, UbxBytes(4).u32(0, itow_ms).bytes());
}

}  // namespace waymark_test
