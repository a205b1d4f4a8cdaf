/// Reads one line token by token. Errors name file, line and column. It is for files in which every
/// character counts.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace waymark::formats {

/// Returns a word of a file for a message: in quotes and cut after 40 characters. Bytes beyond
/// ASCII, and those that a terminal could take for a command, become `\xNN`. An empty word becomes
/// "the end of the line".
[[nodiscard]] std::string quote_word(std::string_view word);

/// Returns a name from a file for a message: without quotes and cut after 40 bytes. Control
/// characters become `\xNN`; characters beyond ASCII are kept.
[[nodiscard]] std::string shown_name(std::string_view name);

/// The expected token. It becomes text only if the scanner fails.
struct Expected {
  std::string_view tag;    ///< word at the beginning of the line
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

  /// Returns the next word, empty at the end of the line.
  std::string_view word() {
    skip_blanks();
    while (cursor_ != end_ && !is_blank(*cursor_)) ++cursor_;
    return {word_, static_cast<std::size_t>(cursor_ - word_)};
  }
  /// Returns the rest of the line without surrounding blanks.
  std::string_view rest();
  /// Tells whether only blanks and a comment are left.
  [[nodiscard]] bool at_end() const { return LineScanner(*this).next_is_comment(); }

  /// Reads a finite number. @throws InputError
  double number(const Expected& expected);
  /// Reads a finite number, or nothing for the word "-".
  std::optional<double> optional_number(const Expected& expected);
  std::int64_t integer(const Expected& expected);
  /// @throws InputError if anything but a comment is left
  void end(std::string_view tag) {
    if (!next_is_comment()) fail_end(tag);
  }

  /// @throws InputError at the column of the last word
  [[noreturn]] void fail(const std::string& message) const;

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

  void skip_blanks() {
    while (cursor_ != end_ && is_blank(*cursor_)) ++cursor_;
    word_ = cursor_;
  }
  [[nodiscard]] bool ends_word(const char* place) const { return place == end_ || is_blank(*place); }
  bool next_is_comment() {
    skip_blanks();
    return cursor_ == end_ || *cursor_ == '#';
  }
  [[noreturn]] void fail_end(std::string_view tag);
  [[noreturn]] void fail_expected(const char* what, const Expected& expected, std::string_view got) const;

  const char* begin_;
  const char* end_;
  const char* cursor_;
  const char* word_;  // beginning of the last word
  const std::string& file_;
  std::size_t line_number_;
};

}  // namespace waymark::formats
