#include <waymark/formats/text_builder.hpp>

#include <cmath>

#include <fmt/compile.h>

namespace waymark {
namespace {

constexpr int kLongestDouble = 24;  // -2.2250738585072014e-308

/// A whole number that to_chars writes without exponent: it has at most four zeros at its end.
bool is_plain_integer(double value) {
  constexpr double kAllExact = 9007199254740992;  // 2^53
  constexpr std::int64_t kZeros = 100'000;
  if (!(std::abs(value) < kAllExact)) return false;
  const auto whole = static_cast<std::int64_t>(value);
  return static_cast<double>(whole) == value && whole % kZeros != 0;
}

/// Where the shortest form of a number that is not whole has no exponent in fmt's reading and in to_chars'.
bool is_plain_decimal(double value) {
  const double magnitude = std::abs(value);
  return magnitude >= 1e-3 && magnitude < 1e15;
}

}  // namespace

TextBuilder::TextBuilder(TextSink sink)
    : sink_(std::move(sink)),
      buffer_(std::make_unique_for_overwrite<char[]>(kPiece)),
      cursor_(buffer_.get()) {}

void TextBuilder::flush() {
  const std::string_view piece(buffer_.get(), static_cast<std::size_t>(cursor_ - buffer_.get()));
  if (!piece.empty()) sink_(piece);
  cursor_ = buffer_.get();
}

TextBuilder& TextBuilder::long_word(std::string_view text) {
  flush();
  sink_(text);
  return *this;
}

// to_chars alone would do. fmt finds the same shortest digits in a third of the time (Dragonbox; the
// library's Ryu is slower still at laying them out) and writes them alike in the range where neither uses an
// exponent.
char* TextBuilder::write_number(char* place, double value) {
  if (value == 0 && !std::signbit(value)) {
    *place = '0';
    return place + 1;
  }
  if (is_plain_integer(value))
    return std::to_chars(place, place + kLongestDouble, static_cast<std::int64_t>(value)).ptr;
  if (is_plain_decimal(value) && value != std::trunc(value))
    return fmt::format_to(place, FMT_COMPILE("{}"), value);
  return std::to_chars(place, place + kLongestDouble, value).ptr;
}

}  // namespace waymark
