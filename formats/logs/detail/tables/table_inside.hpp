/// The base of decoders for logs that hold a table among other lines.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/formats/logs/detail/common/line_decoder.hpp>

namespace waymark::formats {

/// A quantity, and the names that its column may have.
struct KnownColumn {
  std::string_view quantity;
  std::string_view unit;
  std::string_view convention;
  std::initializer_list<std::string_view> names;
};

/// Gives the rows of the table to the CSV reader, which has the rules for numbers, accuracies and
/// damage. Its messages have the line numbers of the log.
class TableInside : public LineDecoder {
 public:
  using LineDecoder::LineDecoder;

 protected:
  /// Opens the table. @param header its column names, `separator` between them
  /// @param number line of the header in the log
  /// @param known columns that are used if the table has them and the request does not state others
  /// @param own scale of the stamps in the log; those of the samples are on the request's
  void open_table(std::string_view header, std::size_t number, std::span<const KnownColumn> known,
                  char separator, TimeScale own, LogRequest inner);
  [[nodiscard]] bool is_open() const { return table_ != nullptr; }
  /// Gives a row to the table.
  void give_row(std::string_view row, std::size_t number);
  /// Takes over counts and notes.
  /// @throws InputError as the CSV reader
  void finish_table();

 private:
  void give(std::string_view line);
  void move_samples();

  std::unique_ptr<LogDecoder> table_;
  std::size_t given_ = 0;  ///< lines that the table has
  TimeScale own_ = TimeScale::utc;
};

}  // namespace waymark::formats
