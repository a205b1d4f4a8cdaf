/// The fields of a record in text: cut without copies, read as numbers.
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
  /// Words between any runs of blanks, tabs, ',' and ';'.
  void split_words(std::string_view line);
  /// Fields between single separators, empty ones too. Separators within double quotes count as text.
  void split_at(std::string_view line, char separator);

  /// How many fields the line has; those beyond the first 48 are counted, not kept.
  [[nodiscard]] std::size_t count() const { return count_; }
  /// Empty for a field that the line does not have.
  [[nodiscard]] std::string_view operator[](std::size_t index) const {
    return index < count_ && index < kKept ? kept_[index] : std::string_view();
  }
  /// 1-based place of a field in its line; that of the line's end for one that it does not have.
  [[nodiscard]] std::size_t column(std::size_t index) const;

 private:
  static constexpr std::size_t kKept = 48;  // more than any record of these formats has
  void add(std::string_view field);

  std::string_view line_;
  std::array<std::string_view, kKept> kept_;
  std::size_t count_ = 0;
};

/// A field as messages show it: in quotes, cut after 40 characters, without bytes that a terminal could take
/// for a command.
[[nodiscard]] std::string quote_field(std::string_view field);
/// A finite decimal number that fills the field, with an optional sign and exponent.
[[nodiscard]] std::optional<double> field_number(std::string_view field);
/// A whole number 0 .. 999,999,999 of digits alone.
[[nodiscard]] std::optional<int> field_count(std::string_view field);

}  // namespace waymark::formats
