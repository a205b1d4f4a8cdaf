/// The byte order mark of UTF-8, which some editors put before a text.
#pragma once

#include <string_view>

namespace waymark::formats {

/// Returns a text, of which the beginning is known to be the first of its file, without a byte order
/// mark. Some texts have two: one of the program that made them and one of an editor.
[[nodiscard]] constexpr std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  while (text.starts_with(kMark)) text.remove_prefix(kMark.size());
  return text;
}

}  // namespace waymark::formats
