/// Reads one line token by token; errors name file, line and column. For files in which every character
/// counts.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace waymark {

/// A word of a file as a message shows it: in quotes, cut after 40 characters, bytes that a terminal could
/// take for a command (and all beyond ASCII) as \xNN; an empty one is "the end of the line".
[[nodiscard]] std::string quote_word(std::string_view word);

/// What the scanner expected, made into text only when it fails.
struct Expected {
  std::string_view tag;    ///< word at the line's start
  std::string_view field;  ///< name of the number group
  int index = -1;          ///< number within the group, -1: a single one
};

class LineScanner {
 public:
  LineScanner(std::string_view line, const std::string& file, std::size_t line_number)
      : begin_(line.data()),
        end_(line.data() + line.size()),
        cursor_(begin_),
        word_(begin_),
        file_(file),
        line_number_(line_number) {}

  /// The next word, empty at the end of the line.
  std::string_view word() {
    skip_blanks();
    while (cursor_ != end_ && !is_blank(*cursor_)) ++cursor_;
    return {word_, static_cast<std::size_t>(cursor_ - word_)};
  }
  /// The rest of the line without surrounding blanks.
  std::string_view rest();
  /// Whether nothing but blanks and a comment is left.
  [[nodiscard]] bool at_end() const { return LineScanner(*this).next_is_comment(); }

  /// A finite number. @throws InputError
  double number(const Expected& expected) {
    skip_blanks();
    if (const Digits digits = plain_digits(); digits.found) {
      const auto value = static_cast<double>(digits.value);  // exact
      return digits.negative ? -value : value;
    }
    return any_number(expected);
  }
  /// A finite number, or nothing for the word "-".
  std::optional<double> optional_number(const Expected& expected);
  std::int64_t integer(const Expected& expected) {
    skip_blanks();
    if (const Digits digits = plain_digits(); digits.found)
      return digits.negative ? -digits.value : digits.value;
    return any_integer(expected);
  }
  /// @throws InputError where anything but a comment is left.
  void end(std::string_view tag) {
    if (!next_is_comment()) fail_end(tag);
  }

  /// @throws InputError at the column of the last word read.
  [[noreturn]] void fail(const std::string& message) const;

 private:
  /// A word of at most 15 digits behind an optional minus, which every double and int64 holds exactly: most
  /// words of a graph file. Others go the long way.
  struct Digits {
    bool found = false;
    bool negative = false;
    std::int64_t value = 0;
  };

  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

  void skip_blanks() {
    while (cursor_ != end_ && is_blank(*cursor_)) ++cursor_;
    word_ = cursor_;
  }
  /// Moves behind the word where it finds what it looks for, else not at all.
  Digits plain_digits() {
    constexpr std::ptrdiff_t kMost = 15;
    const char* place = cursor_;
    Digits digits;
    digits.negative = place != end_ && *place == '-';
    if (digits.negative) ++place;
    const char* const first = place;
    for (; place != end_ && place - first <= kMost; ++place) {
      const auto digit = static_cast<unsigned char>(*place - '0');
      if (digit > 9) break;
      digits.value = 10 * digits.value + digit;
    }
    const bool whole = place == end_ || is_blank(*place);
    digits.found = whole && place != first && place - first <= kMost;
    if (digits.found) cursor_ = place;
    return digits;
  }
  double any_number(const Expected& expected);
  std::int64_t any_integer(const Expected& expected);
  bool next_is_comment() {
    skip_blanks();
    return cursor_ == end_ || *cursor_ == '#';
  }
  [[noreturn]] void fail_end(std::string_view tag);
  [[noreturn]] void fail_expected(const char* what, const Expected& expected, std::string_view got) const;

  const char* begin_;
  const char* end_;
  const char* cursor_;
  const char* word_;  // where the last word begins
  const std::string& file_;
  std::size_t line_number_;
};

}  // namespace waymark
