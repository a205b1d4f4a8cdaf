/// Text in UTF-16, as Excel saves "Unicode text".
#pragma once

#include <string>
#include <string_view>

namespace waymark::formats {

/// Tells whether a text begins with the byte order mark of UTF-16, or as ASCII in UTF-16 without one.
[[nodiscard]] constexpr bool is_utf16(std::string_view text) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) return true;
  return text.size() >= 2 && (text[0] == '\0') != (text[1] == '\0');
}

/// Converts a text in pieces to UTF-8, if it begins with the byte order mark of UTF-16. Any other text stays.
class Utf16Text {
 public:
  /// Returns the piece as UTF-8. It points into the piece or into this object, until the next call.
  [[nodiscard]] std::string_view converted(std::string_view piece);

 private:
  enum class Kind { unknown, other, little_endian, big_endian };
  void add(unsigned unit);

  Kind kind_ = Kind::unknown;
  std::string rest_;  ///< a byte whose other half comes in the next piece
  std::string text_;
  unsigned surrogate_ = 0;  ///< the first half of a pair
};

}  // namespace waymark::formats
