/// The lines and fields of a separated-values text, without copies.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/formats/text/detail/byte_order_mark.hpp>

namespace waymark::formats {

/// A line with content.
struct TableLine {
  std::string_view text;
  std::size_t number = 0;  ///< 1-based
  /// the last comment between the previous line and this one, without its '#'
  std::string_view comment_above;
  /// the row of units below a header; empty if there is none
  std::string_view units_below = {};
};

/// Visits the lines with content. It skips a byte order mark, blank lines and comments (lines whose
/// first visible character is '#'). Line ends are "\n" or "\r\n".
class CsvLines {
 public:
  explicit CsvLines(std::string_view text) : rest_(without_byte_order_mark(text)) {}

  /// Goes to the next line. @return false at the end of the text
  [[nodiscard]] bool next();
  [[nodiscard]] std::string_view line() const { return line_; }
  [[nodiscard]] std::size_t number() const { return number_; }  ///< 1-based
  /// Returns the last comment between the previous line and this one, without its '#'. Empty if
  /// there is none.
  [[nodiscard]] std::string_view comment_above() const { return comment_; }

 private:
  std::string_view rest_;
  std::string_view line_;
  std::string_view comment_;
  std::size_t number_ = 0;
};

/// Returns the separator of a header: the most frequent of ',' ';' and tab (the first of equals),
/// or a blank if it contains none of them.
[[nodiscard]] char separator_of(std::string_view header);

/// Splits a line into fields, as views into it. Blanks around a field and quotes around its text
/// are left out; a doubled quote inside stays doubled. Separator ' ' stands for any run of blanks
/// and tabs. An empty field after a trailing separator is kept.
/// @return false if a quote is not closed on the line or text follows a closing quote
[[nodiscard]] bool split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields);

/// Returns the 1-based column of a field in its line, in bytes.
[[nodiscard]] inline std::size_t column_of(std::string_view line, std::string_view field) {
  return static_cast<std::size_t>(field.data() - line.data()) + 1;
}

}  // namespace waymark::formats
