/// The fields of a text record. They are cut without copies and read as numbers.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace waymark::formats {

/// The value of a field that is empty.
inline constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

/// The fields of one line, as views into it.
class RecordFields {
 public:
  /// Splits into words at runs of blanks, tabs, ',' and ';'.
  void split_words(std::string_view line);
  /// Splits at single separators; fields may be empty. Separators within double quotes are text.
  void split_at(std::string_view line, char separator);

  /// Returns how many fields the line has. Fields after the first 48 are counted, but not kept.
  [[nodiscard]] std::size_t count() const { return count_; }
  /// Returns an empty field if the line does not have it.
  [[nodiscard]] std::string_view operator[](std::size_t index) const {
    return index < count_ && index < kKept ? kept_[index] : std::string_view();
  }
  /// Returns the 1-based column of a field in its line, or of the end of the line if the field
  /// does not exist.
  [[nodiscard]] std::size_t column(std::size_t index) const;

 private:
  static constexpr std::size_t kKept = 48;  // more than any record of these formats has
  void add(std::string_view field);

  std::string_view line_;
  std::array<std::string_view, kKept> kept_;
  std::size_t count_ = 0;
};

/// Returns a field for messages: in quotes, cut after 40 characters, without bytes that a terminal
/// could take for a command.
[[nodiscard]] std::string quote_field(std::string_view field);
/// Reads a finite decimal number that fills the field. Sign and exponent are optional.
[[nodiscard]] std::optional<double> field_number(std::string_view field);
/// Reads a whole number 0 .. 999,999,999 that consists of digits only.
[[nodiscard]] std::optional<int> field_count(std::string_view field);

}  // namespace waymark::formats
