#include <waymark/formats/logs/detail/can/can_frame.hpp>

#include <algorithm>

#include <waymark/formats/logs/detail/can/layouts/can_cursor.hpp>
#include <waymark/formats/text/detail/characters.hpp>
#include <waymark/formats/text/stamp_text.hpp>

namespace waymark::formats {
namespace {

constexpr std::uint32_t kErrorFrame = 0x2000'0000;

/// With `candump -x`, direction and flags are before the id: "RX - -" or "TX B E".
void skip_direction(CanCursor& cursor) {
  const std::string_view rest = cursor.rest();
  if (!rest.starts_with("RX ") && !rest.starts_with("TX ")) return;
  for (int i = 0; i < 3; ++i) {
    (void)cursor.word();
    cursor.skip_blanks();
  }
}

/// Reads the id and sets kind and id. @return the number of its digits, 0 if it is no id
std::size_t read_id(std::string_view text, CanLine& result) {
  std::uint32_t id = 0;
  std::size_t digits = 0;
  while (digits < text.size() && digits < 9 && hex_digit(text[digits]) >= 0) {
    id = (id << 4U) | static_cast<std::uint32_t>(hex_digit(text[digits]));
    ++digits;
  }
  result.id = id;
  if (digits == 3) return id <= kMostStandardId ? digits : 0;
  if (digits != 8) return 0;
  if ((id & kErrorFrame) != 0 && id <= (kErrorFrame | kMostExtendedId)) {
    result.kind = FrameKind::error;
    return digits;
  }
  result.id |= kExtendedFrame;
  return id <= kMostExtendedId ? digits : 0;
}

/// Reads the rest of a line after the id in the console layout: "   [8]  03 41", or "  [08]
/// ..." for CAN FD.
CanLine read_console(CanLine result, CanCursor cursor) {
  cursor.skip_blanks();
  if (cursor.peek() != '[') return can_trouble(cursor, "expected '#' or '[' after the id");
  ++cursor.at;
  std::size_t size = 0;
  const std::size_t begin = cursor.at;
  while (cursor.peek() >= '0' && cursor.peek() <= '9' && cursor.at < begin + 2) {
    size = 10 * size + static_cast<std::size_t>(cursor.peek() - '0');
    ++cursor.at;
  }
  if (cursor.at == begin || cursor.peek() != ']' || size > kMostFrameBytes)
    return can_trouble(cursor, "expected a length of 0 to 64 bytes in brackets");
  ++cursor.at;
  cursor.skip_blanks();
  result.listed_size = static_cast<int>(size);
  result.data = cursor.rest();
  if (result.data.starts_with("remote request")) result.kind = FrameKind::remote;
  return result;
}

/// Reads bytes as decimal numbers with blanks between them.
std::string_view read_decimals(const CanLine& line, CanData& data) {
  const auto wanted = static_cast<std::size_t>(line.listed_size);
  CanCursor cursor{line.data};
  for (data.size = 0; data.size < wanted; ++data.size) {
    cursor.skip_blanks();
    const std::string_view word = cursor.word();
    const auto value = unsigned_number(word, 10);
    if (word.empty()) return "fewer bytes than the stated length";
    if (!value || *value > 255) return "a byte is no decimal number up to 255";
    data.bytes[data.size] = static_cast<std::uint8_t>(*value);
  }
  return {};
}

}  // namespace

CanLine split_can_line(std::string_view line) {
  CanCursor cursor{line};
  cursor.skip_blanks();
  if (cursor.peek() != '(')
    return can_trouble(cursor, "expected a time stamp in parentheses, as candump writes");
  const std::size_t close = line.find(')', ++cursor.at);
  if (close == std::string_view::npos) return can_trouble(cursor, "the time stamp's ')' is missing");
  CanLine result;
  result.stamp = line.substr(cursor.at, close - cursor.at);
  cursor.at = close + 1;
  cursor.skip_blanks();
  result.interface = cursor.word();
  if (result.interface.empty()) return can_trouble(cursor, "expected an interface such as can0");
  cursor.skip_blanks();
  skip_direction(cursor);

  result.kind = FrameKind::data;
  const std::size_t digits = read_id(cursor.rest(), result);
  if (digits == 0)
    return can_trouble(cursor, "expected an id of 3 (000 .. 7FF) or 8 (.. 1FFFFFFF) hex digits");
  cursor.at += digits;
  if (cursor.peek() != '#') {
    if (!is_blank(cursor.peek())) return can_trouble(cursor, "expected '#' after the id");
    return read_console(result, cursor);
  }
  ++cursor.at;
  if (cursor.peek() == 'R') result.kind = FrameKind::remote;
  if (cursor.peek() == '#') {  // CAN FD: one digit of flags
    ++cursor.at;
    if (hex_digit(cursor.peek()) < 0)
      return can_trouble(cursor, "expected one hex digit of CAN FD flags after '##'");
    ++cursor.at;
  }
  result.data = cursor.rest();
  return result;
}

std::string_view read_can_data(const CanLine& line, CanData& data) {
  if (line.decimal) return read_decimals(line, data);
  const bool console = line.listed_size >= 0;
  const std::size_t most = console ? static_cast<std::size_t>(line.listed_size) : kMostFrameBytes;
  const std::string_view text = line.data;
  data.size = 0;
  std::size_t at = 0;
  while (at < text.size() && data.size < most) {
    const int high = hex_digit(text[at]);
    if (high < 0) {
      // In a log, points may separate the bytes. The direction ("R", "T") or a raw length may
      // follow the last byte.
      if (console ? !is_blank(text[at]) : text[at] != '.') break;
      ++at;
      continue;
    }
    const int low = at + 1 < text.size() ? hex_digit(text[at + 1]) : -1;
    if (low < 0) return "half a byte: the data have an odd number of hex digits";
    data.bytes[data.size++] = static_cast<std::uint8_t>(high * 16 + low);
    at += 2;
  }
  if (console) return data.size == most ? std::string_view() : "fewer bytes than the stated length";
  if (at == text.size() || is_blank(text[at]) || text[at] == '_') return {};
  return data.size == most ? "more than 64 bytes of data" : "expected hex digits as data";
}

std::optional<Stamp> can_stamp(std::string_view text) {
  // "1627274455.012500" is the usual form. The general reader takes the others.
  constexpr std::size_t kDecimals = 6;
  const std::size_t point = text.size() > kDecimals ? text.size() - kDecimals - 1 : 0;
  if (point == 0 || point > 10 || text[point] != '.') return stamp_from_decimal_seconds(text);
  std::int64_t microseconds = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (i == point) continue;
    if (text[i] < '0' || text[i] > '9') return stamp_from_decimal_seconds(text);
    microseconds = 10 * microseconds + (text[i] - '0');
  }
  // Ten digits of seconds may reach 9999999999 s, which is more than a stamp holds.
  std::int64_t nanoseconds = 0;
  if (__builtin_mul_overflow(microseconds, std::int64_t{1000}, &nanoseconds)) return std::nullopt;
  return Stamp{nanoseconds};
}

}  // namespace waymark::formats
