#include <waymark/formats/logs/detail/csv/csv_log.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/common/line_decoder.hpp>
#include <waymark/formats/logs/detail/common/log_request.hpp>
#include <waymark/formats/logs/detail/csv/csv_columns.hpp>
#include <waymark/formats/logs/detail/csv/csv_records.hpp>
#include <waymark/formats/logs/detail/csv/csv_table.hpp>
#include <waymark/formats/logs/detail/csv/table_header.hpp>
#include <waymark/formats/text/detail/characters.hpp>

namespace waymark::formats {
namespace {

/// "','", "tabs" and the like, for notes.
std::string separator_name(char separator) {
  if (separator == ' ') return "blanks";
  return separator == '\t' ? "tabs" : fmt::format("'{}'", separator);
}

/// Finds the table in the lines of the log.
class CsvDecoder final : public LineDecoder {
 public:
  using LineDecoder::LineDecoder;

 private:
  void take_line(std::string_view line, std::size_t number) override {
    const std::string_view content = without_blanks(line);
    if (content.empty()) return;
    if (content.front() == '#') {
      comment_ = content.substr(1);
      return;
    }
    if (table_) return table_->read_line(line, number);
    if (first_number_ == 0) {  // the line below it may hold its units
      first_ = line;
      first_comment_ = comment_;
      first_number_ = number;
      return;
    }
    const bool has_units = begin(line);
    if (!has_units) table_->read_line(line, number);
  }
  /// Finds the columns in the first line, which waits. @return whether the second line holds units
  bool begin(std::string_view second) {
    const std::string_view line = first_;
    LogRequest resolved = request();
    if (resolved.separator == 0) {
      resolved.separator = separator_of(line);
      if (resolved.separator != ',')
        note(fmt::format("fields are separated by {} (not stated)", separator_name(resolved.separator)));
    }
    std::vector<std::string_view> fields;
    const bool has_units =
        split_fields(second, resolved.separator, fields) && is_unit_row(fields, resolved.separator);
    columns_.emplace(TableLine{line, first_number_, first_comment_, has_units ? second : std::string_view()},
                     path(), resolved);
    data_.notes.insert(data_.notes.end(), columns_->notes().begin(), columns_->notes().end());
    table_.emplace(*columns_, path(), std::move(resolved), data_);
    if (!columns_->first_line_is_header()) table_->read_line(line, first_number_);
    return has_units && columns_->first_line_is_header();
  }
  void end() override {
    if (first_number_ == 0) throw EmptyLogError(fmt::format("{}: the log is empty", path()));
    if (!table_) begin({});
    table_->finish();
  }

  std::string comment_;
  std::string first_, first_comment_;  ///< the first line with content, and the comment above it
  std::size_t first_number_ = 0;       ///< 0: not met yet
  std::optional<CsvColumns> columns_;
  std::optional<CsvRecords> table_;
};

/// Tells whether a field holds a number or a date.
bool holds_value(std::string_view field, char separator) {
  if (const std::optional<double> number = number_from_field(field, separator)) return !std::isnan(*number);
  return instant_from_field(field, kIso8601, 0) || instant_from_field(field, "dmy", 0) ||
         instant_from_field(field, "mdy", 0);
}

}  // namespace

std::unique_ptr<LogDecoder> CsvLogReader::open(const std::string& path, const LogRequest& request) const {
  require_companions(path, request, "a table");
  return std::make_unique<CsvDecoder>(path, request);
}

Recognition CsvLogReader::recognise(std::string_view head) const {
  const std::size_t cut = head.rfind('\n');
  CsvLines lines(head.substr(0, cut == std::string_view::npos ? head.size() : cut));
  if (!lines.next() || head.find('\0') != std::string_view::npos) return {};
  const char separator = separator_of(lines.line());
  std::vector<std::string_view> fields;
  if (!split_fields(lines.line(), separator, fields) || fields.size() < 2) return {};
  const std::size_t width = fields.size();
  std::size_t rows = 0;
  std::size_t good = 0;
  while (lines.next()) {
    if (rows == 0 && split_fields(lines.line(), separator, fields) && is_unit_row(fields, separator))
      continue;
    ++rows;
    if (!split_fields(lines.line(), separator, fields) || fields.size() != width) continue;
    good += std::any_of(fields.begin(), fields.end(),
                        [separator](std::string_view field) { return holds_value(field, separator); });
  }
  if (rows == 0 || 10 * good < 9 * rows) return {};
  return {0.5, fmt::format("a table of {} columns separated by {}", width, separator_name(separator))};
}

}  // namespace waymark::formats
