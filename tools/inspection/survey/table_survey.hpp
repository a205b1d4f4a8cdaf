/// Describes a table of separated values column by column, before the meaning of its
/// columns is known.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/core/drive/stamp.hpp>
#include <waymark/formats/logs/detail/common/line_decoder.hpp>
#include <waymark/tools/inspection/survey/field_forms.hpp>
#include <waymark/tools/inspection/survey/header_words.hpp>
#include <waymark/tools/inspection/survey/running_statistics.hpp>

namespace waymark::inspection {

/// One column of a table, or one id or signal of a bus.
struct ColumnSummary {
  std::string name;
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
  struct Column {
    ColumnSummary seen;
    FieldForms forms = kAllForms;  ///< those that all words so far may have
    double last = 0;
    bool is_time = false;  ///< by its name; the steps between its values are recorded
    Quantiles steps;
    bool tells_receivers = false;  ///< by its name
  };
  void take_line(std::string_view line, std::size_t number) override;
  void begin(std::string_view line);
  [[nodiscard]] bool holds_values() const;
  void take_field(Column& column, std::string_view field);
  [[nodiscard]] ColumnSummary summary_of(const Column& column) const;

  TableSummary summary_;
  std::string comment_;
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
