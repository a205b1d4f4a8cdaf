/// Builds a text of words and numbers, separated by blanks. A number has the shortest form that
/// reads back exactly (std::to_chars).
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <memory>
#include <string_view>

#include <waymark/formats/text/text_sink.hpp>

namespace waymark::formats {

class TextBuilder {
 public:
  /// @param sink receives the text in pieces, which may end anywhere; finish() sends the last one
  explicit TextBuilder(TextSink sink);

  TextBuilder& word(std::string_view text) {
    separate();
    if (text.size() > room()) return long_word(text);
    cursor_ = std::copy(text.begin(), text.end(), cursor_);
    return *this;
  }
  /// @throws OutputError if the number is not finite: no reader takes it
  TextBuilder& number(double value) {
    separate();
    write_number(value);
    return *this;
  }
  TextBuilder& integer(std::int64_t value) {
    separate();
    cursor_ = std::to_chars(cursor_, end(), value).ptr;
    return *this;
  }
  TextBuilder& end_line() {
    make_room();
    *cursor_++ = '\n';
    line_begins_ = true;
    return *this;
  }
  /// Adds a line with a word and an integer.
  TextBuilder& line(std::string_view text, std::int64_t value) {
    return word(text).integer(value).end_line();
  }

  /// Sends the rest of the text.
  void finish() { flush(); }

 private:
  static constexpr std::size_t kPiece = 1U << 18U;
  static constexpr std::size_t kLongestNumber = 32;  // 24 characters and a blank fit

  [[nodiscard]] char* end() { return buffer_.get() + kPiece; }
  [[nodiscard]] std::size_t room() { return static_cast<std::size_t>(end() - cursor_); }
  void make_room() {
    if (room() < kLongestNumber) flush();
  }
  void separate() {
    make_room();
    if (!line_begins_) *cursor_++ = ' ';
    line_begins_ = false;
  }
  void flush();
  TextBuilder& long_word(std::string_view text);
  void write_number(double value);

  /// A number and its text.
  struct Recent {
    std::uint64_t bits = 0;
    std::array<char, 24> text{'0'};  // as long as the longest number
    std::ptrdiff_t length = 1;
  };
  static constexpr unsigned kRecentBits = 6;

  TextSink sink_;
  std::unique_ptr<char[]> buffer_;
  char* cursor_;
  std::array<Recent, 1U << kRecentBits> recent_;  // by hash; at first every entry is the number 0
  bool line_begins_ = true;
};

}  // namespace waymark::formats
