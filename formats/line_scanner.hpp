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
      : line_(line), file_(file), line_number_(line_number) {}

  /// The next word, empty at the end of the line.
  std::string_view word();
  /// The rest of the line without surrounding blanks.
  std::string_view rest();
  /// Whether nothing but blanks and a comment is left.
  [[nodiscard]] bool at_end() const { return LineScanner(*this).next_is_comment(); }
  /// A finite number. @throws InputError
  double number(const Expected& expected);
  /// A finite number, or nothing for the word "-".
  std::optional<double> optional_number(const Expected& expected);
  std::int64_t integer(const Expected& expected);
  /// @throws InputError where anything but a comment is left.
  void end(std::string_view tag);

  /// @throws InputError at the column of the last word read.
  [[noreturn]] void fail(const std::string& message) const;

 private:
  [[noreturn]] void fail_expected(const char* what, const Expected& expected, std::string_view got) const;
  bool next_is_comment() {
    const std::string_view next = word();
    return next.empty() || next.front() == '#';
  }

  std::string_view line_;
  const std::string& file_;
  std::size_t line_number_;
  std::size_t cursor_ = 0;
  std::size_t word_start_ = 0;
};

}  // namespace waymark
