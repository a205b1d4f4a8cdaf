/// Walks through the words of a line of CAN logs; private to their layouts.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include <waymark/formats/logs/detail/can/can_frame.hpp>
#include <waymark/formats/text/detail/characters.hpp>

namespace waymark::formats {

/// The value of each hex digit; negative for other characters.
inline constexpr auto kHexDigits = [] {
  std::array<std::int8_t, 256> values{};
  values.fill(-1);
  for (int i = 0; i < 10; ++i) values[static_cast<std::size_t>('0' + i)] = static_cast<std::int8_t>(i);
  for (int i = 0; i < 6; ++i) {
    values[static_cast<std::size_t>('A' + i)] = static_cast<std::int8_t>(10 + i);
    values[static_cast<std::size_t>('a' + i)] = static_cast<std::int8_t>(10 + i);
  }
  return values;
}();

inline int hex_digit(char c) {
  return kHexDigits[static_cast<unsigned char>(c)];
}

/// Reads a number of at most 32 bits that fills the whole text.
inline std::optional<std::uint32_t> unsigned_number(std::string_view text, int base) {
  std::uint32_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value, base);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

/// A place in a line.
struct CanCursor {
  std::string_view line;
  std::size_t at = 0;

  [[nodiscard]] bool at_end() const { return at >= line.size(); }
  [[nodiscard]] char peek() const { return at_end() ? '\0' : line[at]; }
  [[nodiscard]] std::string_view rest() const { return line.substr(std::min(at, line.size())); }
  void skip_blanks() {
    while (at < line.size() && is_blank(line[at])) ++at;
  }
  std::string_view word() {
    const std::size_t begin = at;
    while (at < line.size() && !is_blank(line[at])) ++at;
    return line.substr(begin, at - begin);
  }
  /// Skips blanks and returns the word behind them; `at` is behind it, `word_at` at its beginning.
  std::string_view next_word() {
    skip_blanks();
    word_at = at;
    return word();
  }

  std::size_t word_at = 0;
};

/// A line that is no frame.
/// @param at 0-based place of the error
inline CanLine can_trouble(std::size_t at, std::string_view what) {
  CanLine result;
  result.column = at + 1;
  result.what = what;
  return result;
}
inline CanLine can_trouble(const CanCursor& cursor, std::string_view what) {
  return can_trouble(cursor.at, what);
}

}  // namespace waymark::formats
