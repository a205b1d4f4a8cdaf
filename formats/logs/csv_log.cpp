#include <waymark/formats/logs/csv_log.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <waymark/core/error.hpp>
#include <waymark/formats/iso8601.hpp>
#include <waymark/formats/logs/csv_bindings.hpp>
#include <waymark/formats/logs/csv_columns.hpp>
#include <waymark/formats/logs/csv_table.hpp>
#include <waymark/formats/logs/line_decoder.hpp>
#include <waymark/formats/logs/log_request.hpp>
#include <waymark/formats/logs/position_stream.hpp>
#include <waymark/formats/logs/table_accuracy.hpp>
#include <waymark/formats/stamp_text.hpp>

namespace waymark {
namespace {

constexpr std::int64_t kNanosecondsPerWeek = 604'800'000'000'000;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// "','", "tabs" and the like, for notes.
std::string separator_name(char separator) {
  if (separator == ' ') return "blanks";
  return separator == '\t' ? "tabs" : fmt::format("'{}'", separator);
}

/// The first complaint about the line at hand.
struct Complaint {
  std::size_t column = 0;  ///< 0: none
  std::string what;
};

/// Reads the table line by line.
class TableReader {
 public:
  TableReader(const CsvColumns& columns, const std::string& path, LogRequest request, LogData& data)
      : bound_(columns),
        field_count_(columns.field_count()),
        path_(path),
        request_(std::move(request)),
        data_(data),
        positions_(path, request_, nullptr) {
    offset_ = request_.gps_week * kNanosecondsPerWeek + std::llround(request_.time_offset_s * 1e9);
    if (request_.stream == StreamKind::gnss && request_.readings.empty()) {
      const auto has = [&](std::string_view name) { return columns.find(name) != nullptr; };
      accuracy_ = choose_accuracy(has, path, request_, data.notes);
      accuracy_east_ = columns.find(accuracy_.east);
      accuracy_north_ = columns.find(accuracy_.north);
      covariance_root_ = columns.find(accuracy_.covariance_root);
    }
    for (const SensorColumn& column : request_.readings) readings_.push_back(columns.find(column.name));
    data.readings.columns = request_.readings.size();
  }

  void read_line(std::string_view line, std::size_t number) {
    ++data_.records;
    line_ = line;
    complaint_ = {};
    number_ = number;
    if (check_fields()) read_sample();
    if (complaint_.column != 0) add_corrupt(data_, path_, number_, complaint_.column, complaint_.what);
  }

  void finish() { positions_.finish(data_); }

 private:
  bool check_fields();
  void read_sample();
  void read_readings(Stamp at);
  [[nodiscard]] std::optional<Stamp> instant(const BoundColumn& column);
  [[nodiscard]] std::optional<Stamp> stamp();
  [[nodiscard]] double number(const BoundColumn* column, bool required);
  [[nodiscard]] std::optional<double> optional_number(const BoundColumn* column);
  [[nodiscard]] std::optional<double> optional_sigma(const BoundColumn* column);
  [[nodiscard]] bool has_fix();
  void set_covariance(GeodeticFix& fix);
  void complain(const BoundColumn& column, std::string what);

  Bindings bound_;
  std::vector<const BoundColumn*> readings_;  ///< of a sensor, as LogRequest::readings; null: no such column
  std::size_t field_count_;
  const std::string& path_;
  const LogRequest request_;
  LogData& data_;
  PositionStream positions_;
  AccuracyQuantities accuracy_;
  const BoundColumn *accuracy_east_ = nullptr, *accuracy_north_ = nullptr, *covariance_root_ = nullptr;
  std::int64_t offset_ = 0;

  std::string_view line_;
  std::size_t number_ = 0;
  std::vector<std::string_view> fields_;
  std::vector<double> row_;
  Complaint complaint_;
};

bool TableReader::check_fields() {
  if (!split_fields(line_, request_.separator, fields_)) {
    complaint_ = {line_.size() + 1, "a quoted field is not closed or text follows its end"};
    return false;
  }
  const bool trailing_separator = fields_.size() == field_count_ + 1 && fields_.back().empty();
  if (fields_.size() == field_count_ || trailing_separator) return true;
  const std::size_t column =
      fields_.size() > field_count_ ? column_of(line_, fields_[field_count_]) : line_.size() + 1;
  complaint_ = {column, fmt::format("expected {} fields, got {}", field_count_, fields_.size())};
  return false;
}

void TableReader::read_sample() {
  if (request_.stream == StreamKind::gnss && !has_fix()) return;
  const std::optional<Stamp> at = stamp();
  if (!at) return;
  if (request_.stream == StreamKind::sensor || !request_.readings.empty()) return read_readings(*at);
  if (request_.stream == StreamKind::odometry) {
    const OdometrySample sample{*at, number(bound_.speed, true), number(bound_.yaw_rate, true)};
    if (complaint_.column == 0) data_.odometry.push_back(sample);
    return;
  }
  const double latitude = number(bound_.latitude, true);
  const double longitude = number(bound_.longitude, true);
  const double height = number(bound_.height, false);
  if (request_.stream == StreamKind::truth) {
    const GeodeticTruth truth{*at, latitude, longitude, height, optional_number(bound_.heading)};
    if (complaint_.column == 0) data_.truth.push_back(truth);
    return;
  }
  GeodeticFix fix;
  fix.stamp = *at;
  fix.latitude_deg = latitude;
  fix.longitude_deg = longitude;
  fix.height_m = height;
  set_covariance(fix);
  fix.course_rad = optional_number(bound_.course);
  fix.course_sigma_rad = optional_sigma(bound_.course_accuracy);
  fix.speed_mps = optional_number(bound_.speed);
  fix.speed_sigma_mps = optional_sigma(bound_.speed_accuracy);
  fix.line = number_;
  const std::optional<Stamp> told = bound_.gnss_time ? instant(*bound_.gnss_time) : std::nullopt;
  if (complaint_.column != 0) return;
  positions_.give(data_, fix);
  if (told) data_.clocks.push_back({*at, *told});
}

void TableReader::read_readings(Stamp at) {
  row_.clear();
  for (std::size_t i = 0; i < request_.readings.size(); ++i)
    row_.push_back(number(readings_[i], request_.readings[i].required));
  if (complaint_.column != 0) return;
  data_.readings.stamps.push_back(at);
  data_.readings.values.insert(data_.readings.values.end(), row_.begin(), row_.end());
}

/// The instant in a column of times, as it stands there.
std::optional<Stamp> TableReader::instant(const BoundColumn& column) {
  const std::string_view field = fields_[column.field];
  std::optional<Stamp> stamp;
  if (column.unit == kIso8601) {
    stamp = stamp_from_iso8601(field);
    if (stamp) stamp = convert(*stamp, TimeScale::utc, request_.time_scale);
  } else if (column.time_power == 0) {
    stamp = stamp_from_decimal_seconds(field);
  } else if (field.find_first_of("eE") == std::string_view::npos) {
    stamp = stamp_from_decimal_seconds(fmt::format("{}e{}", field, column.time_power));
  }
  if (!stamp) {
    const char* expected = column.unit == kIso8601 ? "an ISO 8601 date" : "a decimal number";
    complain(column, field.empty() ? "no value" : fmt::format("expected {}, got '{}'", expected, field));
  }
  return stamp;
}

std::optional<Stamp> TableReader::stamp() {
  std::optional<Stamp> stamp = instant(*bound_.time);
  if (!stamp) return std::nullopt;
  const std::string_view field = fields_[bound_.time->field];
  if (request_.gps_week != 0 && (stamp->nanoseconds < 0 || stamp->nanoseconds >= 2 * kNanosecondsPerWeek)) {
    complain(*bound_.time, fmt::format("'{}' is no second of a week", field));
    return std::nullopt;
  }
  if (__builtin_add_overflow(stamp->nanoseconds, offset_, &stamp->nanoseconds)) {
    complain(*bound_.time, fmt::format("'{}' is too large for a stamp", field));
    return std::nullopt;
  }
  return stamp;
}

double TableReader::number(const BoundColumn* column, bool required) {
  if (column == nullptr) return kNone;
  const std::string_view field = fields_[column->field];
  const std::optional<double> given = number_from_field(field);
  if (!given) {
    const bool comma = field.find(',') != std::string_view::npos;
    complain(*column,
             fmt::format("expected a number{}, got '{}'", comma ? " with a decimal point" : "", field));
    return kNone;
  }
  if (std::isnan(*given)) {
    if (required) complain(*column, "no value");
    return kNone;
  }
  const Quantity& quantity = *column->quantity;
  const double scaled =
      column->factor * *given;  // the range is that of the angle as given, before any offset
  if (scaled < quantity.smallest || scaled > quantity.largest) {
    complain(*column, fmt::format("'{}' {} is outside {:.6g} .. {:.6g}", field, column->unit,
                                  quantity.smallest / std::abs(column->factor),
                                  quantity.largest / std::abs(column->factor)));
    return kNone;
  }
  return scaled + column->offset;
}

std::optional<double> TableReader::optional_number(const BoundColumn* column) {
  const double value = number(column, false);
  return std::isnan(value) ? std::nullopt : std::optional(value);
}

std::optional<double> TableReader::optional_sigma(const BoundColumn* column) {
  const double value = number(column, false);
  return value > 0 ? std::optional(value) : std::nullopt;
}

/// Whether the receiver marks the line as a fix.
bool TableReader::has_fix() {
  if (bound_.valid == nullptr) return true;
  const std::string_view field = fields_[bound_.valid->field];
  for (const std::string_view yes : {"true", "True", "TRUE", "A", "yes"}) {
    if (field == yes) return true;
  }
  bool fix = false;
  bool known = false;
  for (const std::string_view no : {"false", "False", "FALSE", "V", "no"}) known = known || field == no;
  if (!known) {
    const double flag = number(bound_.valid, true);
    if (complaint_.column != 0) return false;
    fix = flag != 0;
  }
  if (!fix) ++data_.without_fix;
  return fix;
}

void TableReader::set_covariance(GeodeticFix& fix) {
  const double east = number(accuracy_east_, false);
  const double north = accuracy_north_ == accuracy_east_ ? east : number(accuracy_north_, false);
  const double root = number(covariance_root_, false);
  if (complaint_.column != 0) return;
  const char* what = positions_.set_covariance(fix, table_accuracy(east, north, root, accuracy_));
  if (what == nullptr) return;
  const bool root_is_wrong = east > 0 && north > 0 && covariance_root_ != nullptr;
  complain(*(root_is_wrong ? covariance_root_ : east > 0 ? accuracy_north_ : accuracy_east_), what);
}

void TableReader::complain(const BoundColumn& column, std::string what) {
  if (complaint_.column != 0) return;
  complaint_ = {column_of(line_, fields_[column.field]), fmt::format("{}: {}", column.quantity->name, what)};
}

/// Finds the table in the lines.
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
  std::optional<TableReader> table_;
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
    good += std::any_of(fields.begin(), fields.end(), [](std::string_view field) {
      const std::optional<double> number = number_from_field(field);
      return number && !std::isnan(*number);
    });
  }
  if (rows == 0 || 10 * good < 9 * rows) return {};
  return {0.5, fmt::format("a table of {} columns separated by {}", width, separator_name(separator))};
}

}  // namespace waymark
