#include <waymark/formats/logs/detail/novatel/novatel_message.hpp>

#include <charconv>

#include <fmt/format.h>
#include <zlib.h>

namespace waymark::formats {
namespace {

constexpr std::size_t kLongestName = 32;

bool is_of_name(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

}  // namespace

std::string_view novatel_name(std::string_view line) {
  if (line.empty() || (line[0] != '#' && line[0] != '%')) return {};
  line.remove_prefix(1);
  std::size_t length = 0;
  while (length < line.size() && length <= kLongestName && is_of_name(line[length])) ++length;
  // Every name ends with 'A' for ASCII.
  if (length < 4 || length == line.size() || line[length] != ',' || line[length - 1] != 'A') return {};
  return line.substr(0, length);
}

std::uint32_t novatel_checksum(std::string_view text) {
  // zlib inverts the register before and after.
  const auto* bytes = reinterpret_cast<const Bytef*>(text.data());
  return static_cast<std::uint32_t>(~::crc32_z(0xFFFFFFFFU, bytes, text.size()));
}

std::string read_novatel(std::string_view line, NovatelMessage& message) {
  message.name = novatel_name(line);
  const std::size_t star = line.rfind('*');
  if (star == std::string_view::npos) return "no checksum: the line is cut off";
  const std::string_view digits = line.substr(star + 1, 8);
  std::uint32_t stated = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), stated, 16);
  if (error != std::errc() || digits.size() != 8 || end != digits.data() + 8)
    return "no checksum: the line is cut off";
  const std::uint32_t computed = novatel_checksum(line.substr(1, star - 1));
  if (computed != stated)
    return fmt::format("its checksum is {:08x}, that of its text {:08x}", stated, computed);

  const std::size_t semicolon = line.find(';');
  if (semicolon == std::string_view::npos || semicolon > star) return "no ';' ends its header";
  RecordFields header;
  header.split_at(line.substr(0, semicolon), ',');
  const bool is_short = line[0] == '%';
  if (header.count() < (is_short ? 3 : 7)) return "its header has no time";
  message.time_status = is_short ? std::string_view() : header[4];
  message.week = header[is_short ? 1 : 5];
  message.seconds = header[is_short ? 2 : 6];
  message.body_column = semicolon + 2;
  message.body.split_at(line.substr(semicolon + 1, star - semicolon - 1), ',');
  return {};
}

}  // namespace waymark::formats
