#include <waymark/formats/logs/detail/csv/csv_log.hpp>

#include <algorithm>
#include <charconv>
#include <memory>
#include <optional>
#include <span>
#include <string>
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
#include <waymark/formats/logs/detail/csv/table_start.hpp>
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
  CsvDecoder(const std::string& path, const LogRequest& request)
      : LineDecoder(path, request), separator_(request.separator) {}

 private:
  /// A line that waits until the table is found.
  struct Held {
    std::size_t number = 0;
    std::string comment;  ///< above it
  };

  void take_line(std::string_view line, std::size_t number) override {
    const std::string_view content = without_blanks(line);
    if (content.empty()) return;
    if (content.front() == '#') {
      comment_ = content.substr(1);
      return;
    }
    if (table_) return table_->read_line(line, number);
    if (separator_ == 0 && lines_.empty())
      if (const std::optional<char> stated = stated_separator(line)) {
        separator_ = *stated;
        return note(
            fmt::format("fields are separated by {} (by its first line)", separator_name(separator_)));
      }
    if (is_of_other_kind(line)) return;
    lines_.emplace_back(line);
    held_.push_back({number, comment_});
    const std::optional<TableStart> start = table_start(lines_, separator_);
    if (start || lines_.size() >= kMostLinesAbove) begin(start.value_or(TableStart{}));
  }

  /// Tells whether a line is none that `where` asks for, in a log whose columns are given by number: lines of
  /// another kind may be of another width.
  [[nodiscard]] bool is_of_other_kind(std::string_view line) const {
    const std::optional<RowFilter>& where = request().where;
    const std::size_t number = where ? number_of(where->column) : 0;
    const bool by_number =
        !request().columns.empty() &&
        std::all_of(request().columns.begin(), request().columns.end(),
                    [](const auto& column) { return number_of(column.second.column) > 0; });
    if (number == 0 || !by_number) return false;
    std::vector<std::string_view> fields;
    const char separator = separator_ != 0 ? separator_ : separator_of(line);
    if (!split_fields(line, separator, fields)) return false;
    const bool has_values = std::any_of(
        fields.begin(), fields.end(), [&](std::string_view field) { return holds_value(field, separator); });
    if (!has_values) return false;  // a header, whose units count
    return fields.size() < number || (fields[number - 1] == where->value) != where->equal;
  }
  /// Returns the number of a column that is given by number; 0 for a name.
  static std::size_t number_of(const std::string& column) {
    std::size_t number = 0;
    const char* end = column.data() + column.size();
    return std::from_chars(column.data(), end, number).ptr == end ? number : 0;
  }

  /// Finds the columns, and reads the lines that waited.
  void begin(const TableStart& start) {
    LogRequest resolved = request();
    const std::string& line = lines_[start.header];
    resolved.separator = separator_;
    if (separator_ == 0) {
      resolved.separator = separator_of(line);
      if (resolved.separator != ',')
        note(fmt::format("fields are separated by {} (not stated)", separator_name(resolved.separator)));
    }
    if (start.header > 0)
      note(fmt::format("the table begins in line {}: {} lines above it are left out",
                       held_[start.header].number, start.header));
    const std::size_t units = row_of_units(start, resolved.separator);
    columns_.emplace(TableLine{line, held_[start.header].number, held_[start.header].comment,
                               units < lines_.size() ? std::string_view(lines_[units]) : std::string_view()},
                     path(), resolved);
    data_.notes.insert(data_.notes.end(), columns_->notes().begin(), columns_->notes().end());
    table_.emplace(*columns_, path(), std::move(resolved), data_);
    std::size_t row =
        columns_->first_line_is_header() ? std::max(start.first_row, start.header + 1) : start.header;
    if (columns_->first_line_is_header() && row == units) ++row;
    for (; row < lines_.size(); ++row) table_->read_line(lines_[row], held_[row].number);
    lines_.clear();
  }

  /// Returns the line of units below the header; the number of lines if there is none.
  [[nodiscard]] std::size_t row_of_units(const TableStart& start, char separator) const {
    std::vector<std::string_view> fields;
    for (std::size_t i = start.header + 1;
         i < std::min(lines_.size(), std::max(start.first_row, start.header + 2)); ++i)
      if (split_fields(lines_[i], separator, fields) && is_unit_row(fields, separator)) return i;
    return lines_.size();
  }

  void end() override {
    if (!table_ && lines_.empty()) throw EmptyLogError(fmt::format("{}: the log is empty", path()));
    if (!table_) begin({});
    table_->finish();
  }

  char separator_ = 0;  ///< 0: that of the header
  std::string comment_;
  std::vector<std::string> lines_;  ///< until the table is found
  std::vector<Held> held_;
  std::optional<CsvColumns> columns_;
  std::optional<CsvRecords> table_;
};

}  // namespace

std::unique_ptr<LogDecoder> CsvLogReader::open(const std::string& path, const LogRequest& request) const {
  require_companions(path, request, "a table");
  return std::make_unique<CsvDecoder>(path, request);
}

Recognition CsvLogReader::recognise(std::string_view head) const {
  const std::size_t cut = head.rfind('\n');
  if (head.find('\0') != std::string_view::npos) return {};
  std::vector<std::string> texts;
  char separator = 0;
  for (CsvLines lines(head.substr(0, cut == std::string_view::npos ? head.size() : cut)); lines.next();) {
    const std::optional<char> stated = texts.empty() ? stated_separator(lines.line()) : std::nullopt;
    if (stated)
      separator = *stated;
    else
      texts.emplace_back(lines.line());
  }
  std::optional<TableStart> start;
  for (std::size_t n = 2; n <= std::min(texts.size(), kMostLinesAbove) && !start; ++n)
    start = table_start(std::span(texts).first(n), separator);
  if (texts.empty()) return {};
  const std::string& header = texts[start ? start->header : 0];
  if (separator == 0) separator = separator_of(header);
  std::vector<std::string_view> fields;
  if (!split_fields(header, separator, fields) || fields.size() < 2) return {};
  const std::size_t width = fields.size();
  std::size_t rows = 0;
  std::size_t good = 0;
  for (std::size_t i = start ? std::max(start->first_row, start->header + 1) : 1; i < texts.size(); ++i) {
    if (rows == 0 && split_fields(texts[i], separator, fields) && is_unit_row(fields, separator)) continue;
    ++rows;
    if (!split_fields(texts[i], separator, fields) || fields.size() != width) continue;
    good += std::any_of(fields.begin(), fields.end(),
                        [separator](std::string_view field) { return holds_value(field, separator); });
  }
  if (rows == 0 || 10 * good < 9 * rows) return {};
  return {0.5, fmt::format("a table of {} columns separated by {}", width, separator_name(separator))};
}

}  // namespace waymark::formats
