#include <charconv>
#include <cmath>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/detail/decimal.hpp>
#include <waymark/formats/text/detail/line_scanner.hpp>

namespace waymark::formats {
namespace {

/// Skips one '+', which from_chars does not accept.
const char* skip_plus(const char* begin, const char* end) {
  const bool plus = end - begin > 1 && *begin == '+' && begin[1] != '-';
  return plus ? begin + 1 : begin;
}

void append_shown(std::string& text, std::string_view word, bool beyond_ascii) {
  constexpr std::size_t kLongest = 40;
  constexpr std::string_view kDigits = "0123456789abcdef";
  for (const char c : word.substr(0, kLongest)) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte >= 0x20 && byte < 0x7f) || (beyond_ascii && byte >= 0x80)) {
      text += c;
    } else {
      text += {'\\', 'x', kDigits[byte >> 4U], kDigits[byte & 15U]};
    }
  }
  if (word.size() > kLongest) text += "...";
}

}  // namespace

std::string quote_word(std::string_view word) {
  if (word.empty()) return "the end of the line";
  std::string text = "'";
  append_shown(text, word, false);
  text += '\'';
  return text;
}

std::string shown_name(std::string_view name) {
  std::string text;
  append_shown(text, name, true);
  return text;
}

std::string_view LineScanner::rest() {
  skip_blanks();
  const char* last = end_;
  while (last != cursor_ && is_blank(last[-1])) --last;
  cursor_ = end_;
  return {word_, static_cast<std::size_t>(last - word_)};
}

double LineScanner::number(const Expected& expected) {
  skip_blanks();
  if (const Decimal plain = read_plain_decimal(cursor_, end_); plain.end != nullptr && ends_word(plain.end)) {
    cursor_ = plain.end;
    return plain.value;
  }
  const std::string_view text = word();
  const char* end = text.data() + text.size();
  double value = 0;
  const auto [stop, error] = std::from_chars(skip_plus(text.data(), end), end, value);
  if (error == std::errc::result_out_of_range) fail_expected("a number that fits a double", expected, text);
  if (error != std::errc() || stop != end) fail_expected("a number", expected, text);
  if (!std::isfinite(value)) fail_expected("a finite number", expected, text);
  return value;
}

std::optional<double> LineScanner::optional_number(const Expected& expected) {
  const char* before = cursor_;
  if (word() == "-") return std::nullopt;
  cursor_ = before;
  return number(expected);
}

std::int64_t LineScanner::integer(const Expected& expected) {
  const std::string_view text = word();
  const char* end = text.data() + text.size();
  std::int64_t value = 0;
  const auto [stop, error] = std::from_chars(skip_plus(text.data(), end), end, value);
  if (error == std::errc::result_out_of_range) fail_expected("an integer of 64 bits", expected, text);
  if (error != std::errc() || stop != end) fail_expected("an integer", expected, text);
  return value;
}

void LineScanner::fail_end(std::string_view tag) {
  fail(std::string(tag) + ": expected the end of the line, got " + quote_word(word()));
}

void LineScanner::fail(const std::string& message) const {
  throw InputError(file_ + ":" + std::to_string(line_number_) + ":" + std::to_string(word_ - begin_ + 1) +
                   ": " + message);
}

void LineScanner::fail_expected(const char* what, const Expected& expected, std::string_view got) const {
  std::string message =
      std::string(expected.tag) + ": expected " + what + " for '" + std::string(expected.field);
  if (expected.index >= 0) message += "[" + std::to_string(expected.index) + "]";
  message += "', got " + quote_word(got);
  fail(message);
}

}  // namespace waymark::formats
