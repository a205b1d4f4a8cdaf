/// How text for people is shown: colours and width. A pipe or a file has neither.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace waymark::text {

struct TextLook {
  bool colours = false;
  std::size_t columns = 0;  ///< width of the terminal; 0: unlimited
};

enum class Tone { heading, dim, better, worse, warning, error };

/// Returns the text in the colour of the tone (ECMA-48 "select graphic rendition"), or unchanged
/// without colours.
[[nodiscard]] std::string painted(std::string_view text, Tone tone, const TextLook& look);

/// Returns how many columns UTF-8 text takes on a terminal. It counts one for each code point, and
/// two from U+1100 on, where wide characters begin. The result is never too small, so a line that
/// fits by this measure does fit.
[[nodiscard]] std::size_t display_width(std::string_view text);

/// Returns the text within this many columns, cut with "..." if necessary. Characters that control
/// terminals become '?'.
[[nodiscard]] std::string fitted(std::string_view text, std::size_t columns);

/// Returns text that is safe on a terminal, whatever names and messages from outside it holds: bytes
/// that control terminals, and those that are no UTF-8, become `\xNN`. The ends of lines, tabs and
/// the colours of painted() stay.
[[nodiscard]] std::string without_controls(std::string_view text);

/// Returns a message without controls whose words have at most `longest` bytes. A longer one, such
/// as a name from a file, loses its middle, because its end may be a place.
[[nodiscard]] std::string shown_message(std::string_view text, std::size_t longest = 200);

/// Returns the lines, each that is not empty behind so many spaces.
[[nodiscard]] std::string indented(std::string_view lines, std::size_t spaces);

}  // namespace waymark::text
