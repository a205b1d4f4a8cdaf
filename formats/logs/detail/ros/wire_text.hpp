/// Numbers and texts as records of MCAP files and bags hold them: little endian, without alignment. And what marks both
/// files.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

namespace waymark::formats {

/// Returns the bytes of a number, the lowest first.
template <typename Number>
[[nodiscard]] std::string wire_bytes(Number number) {
  char raw[sizeof(Number)];
  std::memcpy(raw, &number, sizeof number);
  if constexpr (std::endian::native == std::endian::big)
    for (std::size_t i = 0; i < sizeof(Number) / 2; ++i) std::swap(raw[i], raw[sizeof(Number) - 1 - i]);
  return {raw, sizeof(Number)};
}

/// Returns a text behind its length in 4 bytes.
[[nodiscard]] inline std::string wire_text(std::string_view text) {
  return wire_bytes(static_cast<std::uint32_t>(text.size())) + std::string(text);
}

/// Opcodes of MCAP records that are read or written.
enum class McapOpcode : unsigned char {
  header = 1,
  footer = 2,
  schema = 3,
  channel = 4,
  message = 5,
  chunk = 6,
  data_end = 15
};
inline constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";
inline constexpr std::string_view kBagMagic = "#ROSBAG V2.0\n";

/// Returns a record of an MCAP file: opcode, length, content (mcap.dev/spec).
[[nodiscard]] inline std::string mcap_record(McapOpcode opcode, std::string_view content) {
  return std::string(1, static_cast<char>(opcode)) + wire_bytes(static_cast<std::uint64_t>(content.size())) +
         std::string(content);
}

}  // namespace waymark::formats
