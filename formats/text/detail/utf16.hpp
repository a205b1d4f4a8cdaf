/// Text in UTF-16, as Excel saves "Unicode text".
#pragma once

#include <string>
#include <string_view>

namespace waymark::formats {

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
