/// Builds a text of words and numbers separated by blanks; numbers in the shortest form that reads back
/// exactly.
#pragma once

#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>

namespace waymark {

class TextBuilder {
 public:
  TextBuilder& word(std::string_view text) {
    separate();
    text_.append(text);
    return *this;
  }
  TextBuilder& number(double value) { return append(value); }
  TextBuilder& integer(std::int64_t value) { return append(value); }
  TextBuilder& end_line() {
    text_.push_back('\n');
    return *this;
  }
  /// A line of a word and an integer.
  TextBuilder& line(std::string_view text, std::int64_t value) {
    return word(text).integer(value).end_line();
  }

  [[nodiscard]] std::string text() && { return std::move(text_); }

 private:
  void separate() {
    if (!text_.empty() && text_.back() != '\n') text_.push_back(' ');
  }
  template <typename T>
  TextBuilder& append(T value) {
    separate();
    char buffer[32];
    text_.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
    return *this;
  }

  std::string text_;
};

}  // namespace waymark
