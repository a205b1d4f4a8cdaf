/// Recognises logs that write -1 where a speed or a course is not known, as those of iOS do.
#pragma once

#include <cmath>
#include <cstddef>

#include <waymark/core/drive/log_reader.hpp>
#include <waymark/formats/logs/detail/csv/csv_columns.hpp>

namespace waymark::formats {

/// Watches the numbers of one column, as the file has them. They are marks if -1 is the only negative number,
/// comes several times, and others have fractions: a vehicle that reverses has speeds between 0 and -1 then.
class UnknownMarks {
 public:
  /// @param column null: there is none, and nothing is found. One with a stated ColumnRequest::missing is not
  /// watched either
  explicit UnknownMarks(const BoundColumn* column)
      : column_(column != nullptr && !column->missing ? column : nullptr) {}

  void see(const BoundColumn* column, double number) {
    if (column != column_ || column == nullptr) return;
    if (number == -1) {
      ++marks_;
    } else {
      has_others_ = true;
      others_are_negative_ = others_are_negative_ || number < 0;
      others_have_fractions_ = others_have_fractions_ || number != std::floor(number);
    }
  }
  /// Tells whether -1 is a mark by what was seen before it, for those who cannot wait for the end.
  [[nodiscard]] bool is_mark_so_far(const BoundColumn* column, double number) const {
    const bool others_allow = others_have_fractions_ || !has_others_;
    return column == column_ && column != nullptr && number == -1 && others_allow && !others_are_negative_;
  }
  [[nodiscard]] bool found() const {
    constexpr std::size_t kFewest = 3;
    return marks_ >= kFewest && others_have_fractions_ && !others_are_negative_;
  }
  /// Tells whether a value of the quantity comes from a mark; only if found().
  [[nodiscard]] bool is_mark(double value) const {
    return (value - column_->offset) / column_->factor < -0.5;
  }
  /// @pre found()
  [[nodiscard]] const BoundColumn& column() const { return *column_; }

 private:
  const BoundColumn* column_;
  std::size_t marks_ = 0;
  bool has_others_ = false;
  bool others_are_negative_ = false;
  bool others_have_fractions_ = false;
};

/// Takes the values of a column that are marks out of the samples. An odometry sample without a speed is
/// removed. @return how many
std::size_t take_out_marks(const UnknownMarks& marks, const LogRequest& request, LogData& data);

}  // namespace waymark::formats
