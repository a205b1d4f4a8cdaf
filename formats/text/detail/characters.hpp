/// Classes of characters. Unlike those of <cctype> they do not depend on the locale.
#pragma once

namespace waymark::formats {

[[nodiscard]] constexpr bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// A space or a tab.
[[nodiscard]] constexpr bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

}  // namespace waymark::formats
