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
    const std::string_view content = table_content(line, number);
    if (content.empty()) return;
    if (content.front() == '#') {
      comment_ = content.substr(1);
      return;
    }
    if (number == 1) line = content;  // without a byte order mark
    if (table_) {
      table_->read_line(line, number);
    } else {
      begin(line, number);
    }
  }
  void begin(std::string_view line, std::size_t number) {
    LogRequest resolved = request();
    if (resolved.separator == 0) {
      resolved.separator = separator_of(line);
      if (resolved.separator != ',')
        note(fmt::format("fields are separated by {} (not stated)", separator_name(resolved.separator)));
    }
    columns_.emplace(TableLine{line, number, comment_}, path(), resolved);
    data_.notes.insert(data_.notes.end(), columns_->notes().begin(), columns_->notes().end());
    table_.emplace(*columns_, path(), std::move(resolved), data_);
    if (!columns_->first_line_is_header()) table_->read_line(line, number);
  }
  void end() override {
    if (!table_) throw InputError(fmt::format("{}: the log is empty", path()));
    table_->finish();
  }

  std::string comment_;
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
  CsvLines lines(head.substr(0, cut == std::string_view::npos ? head.size() : cut));
  if (!lines.next() || head.find('\0') != std::string_view::npos) return {};
  const char separator = separator_of(lines.line());
  std::vector<std::string_view> fields;
  if (!split_fields(lines.line(), separator, fields) || fields.size() < 2) return {};
  const std::size_t width = fields.size();
  std::size_t rows = 0;
  std::size_t good = 0;
  while (lines.next()) {
    ++rows;
    if (!split_fields(lines.line(), separator, fields) || fields.size() != width) continue;
    good += std::any_of(fields.begin(), fields.end(), [separator](std::string_view field) {
      const std::optional<double> number = number_from_field(field, separator);
      return number && !std::isnan(*number);
    });
  }
  if (rows == 0 || 10 * good < 9 * rows) return {};
  return {0.5, fmt::format("a table of {} columns separated by {}", width, separator_name(separator))};
}

}  // namespace waymark::formats
