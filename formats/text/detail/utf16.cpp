#include <waymark/formats/text/detail/utf16.hpp>

namespace waymark::formats {

std::string_view Utf16Text::converted(std::string_view piece) {
  if (kind_ == Kind::other) return piece;
  if (kind_ == Kind::unknown) {
    if (piece.starts_with("\xFF\xFE")) {
      kind_ = Kind::little_endian;
    } else if (piece.starts_with("\xFE\xFF")) {
      kind_ = Kind::big_endian;
    } else {
      kind_ = Kind::other;
      return piece;
    }
    piece.remove_prefix(2);
  }
  text_.clear();
  const auto byte = [](char c) { return static_cast<unsigned>(static_cast<unsigned char>(c)); };
  for (const char c : piece) {
    rest_ += c;
    if (rest_.size() < 2) continue;
    const bool little = kind_ == Kind::little_endian;
    add(little ? byte(rest_[0]) | byte(rest_[1]) << 8U : byte(rest_[1]) | byte(rest_[0]) << 8U);
    rest_.clear();
  }
  return text_;
}

/// Adds a unit; pairs of surrogates are one character.
void Utf16Text::add(unsigned unit) {
  if (unit >= 0xD800 && unit < 0xDC00) {
    surrogate_ = unit;
    return;
  }
  unsigned point = unit;
  if (unit >= 0xDC00 && unit < 0xE000)
    point = surrogate_ != 0 ? 0x10000 + ((surrogate_ - 0xD800) << 10U) + (unit - 0xDC00) : 0xFFFD;
  surrogate_ = 0;
  const auto put = [&](unsigned bits) { text_ += static_cast<char>(bits); };
  if (point < 0x80) {
    put(point);
  } else if (point < 0x800) {
    put(0xC0 | point >> 6U);
    put(0x80 | (point & 0x3FU));
  } else {
    if (point >= 0x10000) {
      put(0xF0 | point >> 18U);
      put(0x80 | (point >> 12U & 0x3FU));
    } else {
      put(0xE0 | point >> 12U);
    }
    put(0x80 | (point >> 6U & 0x3FU));
    put(0x80 | (point & 0x3FU));
  }
}

}  // namespace waymark::formats
