/// Describes a table of separated values column by column, before the meaning of its
/// columns is known.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/core/drive/stamp.hpp>
#include <waymark/formats/logs/detail/common/line_decoder.hpp>
#include <waymark/formats/logs/detail/csv/table_start.hpp>
#include <waymark/tools/inspection/survey/field_forms.hpp>
#include <waymark/tools/inspection/survey/header_words.hpp>
#include <waymark/tools/inspection/survey/running_statistics.hpp>

namespace waymark::inspection {

/// One column of a table, or one id or signal of a bus.
struct ColumnSummary {
  std::string name;
  std::string number;      ///< of a column whose name others have, too; else empty
  std::size_t values = 0;  ///< fields with a value; of a bus: frames
  std::size_t empty = 0;   ///< fields without a value
  std::size_t words = 0;   ///< fields with other text
  Range range;
  double rate_hz = 0;  ///< of a time-like column, an id or a signal
  std::string unit;    ///< as the DBC names it
  std::string detail;  ///< of an id: "8 bytes", "2 interfaces"
  ColumnProposal proposal;
  /// of a column that tells receivers apart: its two to four values; else empty
  std::vector<std::string> receivers;
};

/// Returns how a drive.yaml names a column.
[[nodiscard]] inline const std::string& reference_of(const ColumnSummary& column) {
  return column.number.empty() ? column.name : column.number;
}

struct TableSummary {
  char separator = ',';
  bool has_header = true;
  std::size_t rows = 0;
  std::vector<ColumnSummary> columns;
  std::string first_line;  ///< the comment above the header, if there is one
};

/// At most this many columns are examined. The header of a damaged log may have any number.
inline constexpr std::size_t kMostColumns = 1024;

/// Takes a table line by line. It makes no samples.
class TableSurvey final : public formats::LineDecoder {
 public:
  explicit TableSurvey(const std::string& path) : formats::LineDecoder(path, {}) {}
  /// Returns the columns with proposals. Each quantity is proposed once.
  [[nodiscard]] TableSummary summary() const;

 private:
  /// Numbers that programs write for "not known".
  static constexpr std::array<double, 9> kMarks{-1, 999, -999, 9999, -9999, 99999, -99999, 65535, 32767};

  struct Column {
    ColumnSummary seen;
    FieldForms forms = kAllForms;  ///< those that all words so far may have
    double last = 0;
    bool is_time = false;  ///< by its name; the steps between its values are recorded
    Quantiles steps;
    bool tells_receivers = false;                    ///< by its name
    std::array<std::size_t, kMarks.size()> marks{};  ///< how often each of them came
    Range others;                                    ///< of all other numbers
    bool others_have_fractions = false;
  };
  void take_line(std::string_view line, std::size_t number) override;
  void end() override;
  void take_row(std::string_view line, std::size_t number);
  void begin_waiting(const formats::TableStart& start);
  void begin(std::string_view line);
  static void find_mark(const Column& column, ColumnSummary& seen);
  [[nodiscard]] bool holds_values() const;
  void take_field(Column& column, std::string_view field);
  [[nodiscard]] ColumnSummary summary_of(const Column& column) const;

  TableSummary summary_;
  std::string comment_;
  std::vector<std::string> waiting_;   ///< lines until the table is found
  std::vector<std::size_t> numbers_;   ///< of these lines
  std::vector<std::string> comments_;  ///< above these lines
  char stated_separator_ = 0;
  std::vector<Column> columns_;
  std::size_t width_ = 0;  ///< fields of a line
  std::vector<std::string_view> fields_;
  bool begun_ = false;
  bool may_have_units_ = false;  ///< the next line is the one below the header
};

/// Tells whether a signal of a bus is that of a receiver, by the names of signal and message.
[[nodiscard]] bool is_of_receiver(const std::string& signal);

/// Leaves every quantity to one column: the first whose name indicates it. Columns with a known
/// unit come before others.
/// @param of_bus the columns are signals: the speed of a receiver and that of the vehicle may both stay
void keep_one_each(std::vector<ColumnSummary>& columns, bool of_bus = false);

}  // namespace waymark::inspection
