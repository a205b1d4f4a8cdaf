/// How text for people looks where it goes: in colours and in what width. A pipe or a file has neither.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace waymark::text {

struct TextLook {
  bool colours = false;
  std::size_t columns = 0;  ///< of the terminal; 0: as wide as the text is
};

enum class Tone { heading, dim, better, worse, warning, error };

/// The text in the tone's colour (ECMA-48 "select graphic rendition"), or unchanged without colours.
[[nodiscard]] std::string painted(std::string_view text, Tone tone, const TextLook& look);

/// Columns that UTF-8 text takes on a terminal: one for each code point, two from U+1100 on, where wide
/// characters begin. Never too few, so that a line which fits by this measure does fit.
[[nodiscard]] std::size_t display_width(std::string_view text);

/// The text within so many columns, cut with "..." where it has to be; what steers terminals becomes '?'.
[[nodiscard]] std::string fitted(std::string_view text, std::size_t columns);

}  // namespace waymark::text
