/// Reads one line token by token; errors name file, line and column. For files in which every character
/// counts.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace waymark {

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

  std::string_view line_;
  const std::string& file_;
  std::size_t line_number_;
  std::size_t cursor_ = 0;
  std::size_t word_start_ = 0;
};

}  // namespace waymark
