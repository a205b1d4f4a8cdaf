#include <waymark/formats/logs/detail/csv/csv_records.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/common/gps_time.hpp>
#include <waymark/formats/logs/detail/common/record_fields.hpp>
#include <waymark/formats/logs/detail/csv/csv_table.hpp>
#include <waymark/formats/logs/detail/csv/table_angle.hpp>
#include <waymark/formats/logs/detail/place/geocentric.hpp>
#include <waymark/formats/logs/detail/place/local_plane.hpp>
#include <waymark/formats/text/stamp_text.hpp>

namespace waymark::formats {
namespace {

/// Tells which figures of accuracy a table has. Stated ones come before those that have default names.
std::function<bool(std::string_view)> figures_of(const CsvColumns& columns, const LogRequest& request) {
  const auto states = [&](const std::string& first, const std::string& second) {
    return request.columns.contains(first) || request.columns.contains(second);
  };
  const bool sigmas = states("sigma_east", "sigma_north");
  const bool axes = states("accuracy_east", "accuracy_north");
  const bool radius = states("accuracy", "accuracy");
  return [&columns, sigmas, axes, radius](std::string_view name) {
    if (columns.find(name) == nullptr) return false;
    if (!sigmas && !axes && !radius) return true;
    if (name.starts_with("sigma_")) return sigmas;
    if (name.starts_with("accuracy_")) return axes;
    return name != "accuracy" || radius;
  };
}

}  // namespace

CsvRecords::CsvRecords(const CsvColumns& columns, const std::string& path, LogRequest request, LogData& data)
    : bound_(columns),
      field_count_(columns.field_count()),
      path_(path),
      request_(std::move(request)),
      data_(data),
      positions_(path, request_, nullptr),
      wraps_(bound_.time),
      speed_("speed", request_.stream, columns, path),
      course_("course", request_.stream, columns, path),
      heading_("heading", request_.stream, columns, path),
      filtered_(columns.filtered()),
      unknown_speed_(request_.stream == StreamKind::sensor ? nullptr : bound_.speed),
      unknown_course_(request_.stream == StreamKind::sensor ? nullptr : bound_.course) {
  offset_ = request_.gps_week * kGpsWeekNanoseconds + std::llround(request_.time_offset_s * 1e9);
  require_date(path);
  if (request_.stream == StreamKind::gnss && request_.readings.empty()) {
    accuracy_ = choose_accuracy(figures_of(columns, request_), path, request_, data.notes);
    accuracy_east_ = columns.find(accuracy_.east);
    accuracy_north_ = columns.find(accuracy_.north);
    covariance_root_ = columns.find(accuracy_.covariance_root);
  }
  for (const SensorColumn& column : request_.readings) {
    readings_.push_back(columns.find(column.name));
    composed_.emplace_back(column.name, request_.stream, columns, path);
  }
  data.readings.columns = request_.readings.size();
}

void CsvRecords::read_line(std::string_view line, std::size_t number) {
  ++data_.records;
  line_ = line;
  complaint_ = {};
  number_ = number;
  const bool whole = check_fields();
  if (whole) wraps_.see(fields_[bound_.time->field]);
  if (!is_wanted()) {
    --data_.records;
    ++unwanted_;
    return;
  }
  if (whole) read_sample();
  if (complaint_.column != 0) add_corrupt(data_, path_, number_, complaint_.column, complaint_.what);
}

bool CsvRecords::check_fields() {
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

bool CsvRecords::is_wanted() const {
  // A row of another kind may have another length.
  return !filtered_ || *filtered_ >= fields_.size() ||
         (fields_[*filtered_] == request_.where->value) == request_.where->equal;
}

void CsvRecords::read_sample() {
  if (request_.stream == StreamKind::gnss && !has_fix()) return;
  const std::optional<Stamp> at = stamp();
  if (!at) return;
  if (request_.stream == StreamKind::sensor || !request_.readings.empty()) return read_readings(*at);
  if (request_.stream == StreamKind::odometry) {
    const OdometrySample sample{*at, number(bound_.speed, true), number(bound_.yaw_rate, true)};
    if (complaint_.column == 0 && !std::isnan(sample.speed_mps)) data_.odometry.push_back(sample);
    return;
  }
  request_.stream == StreamKind::truth ? read_truth(*at) : read_fix(*at);
}

void CsvRecords::read_truth(Stamp at) {
  const std::optional<Position> place = position();
  if (!place) return;
  const double height = height_at(*place);
  const GeodeticTruth truth{at, place->latitude_deg, place->longitude_deg, height,
                            optional_value(bound_.heading, heading_)};
  if (complaint_.column == 0) data_.truth.push_back(truth);
}

void CsvRecords::read_fix(Stamp at) {
  const std::optional<Position> place = position();
  if (!place) return;
  GeodeticFix fix;
  fix.stamp = at;
  fix.latitude_deg = place->latitude_deg;
  fix.longitude_deg = place->longitude_deg;
  fix.height_m = height_at(*place);
  if (!read_details(fix)) return;
  set_covariance(fix, place->axes);
  fix.course_rad = optional_value(bound_.course, course_);
  fix.course_sigma_rad = optional_sigma(bound_.course_accuracy);
  fix.speed_mps = optional_value(bound_.speed, speed_);
  fix.speed_sigma_mps = optional_sigma(bound_.speed_accuracy);
  fix.line = number_;
  const std::optional<Stamp> told = bound_.gnss_time ? instant(*bound_.gnss_time) : std::nullopt;
  if (complaint_.column != 0) return;
  positions_.give(data_, fix);
  if (told) data_.clocks.push_back({at, *told});
}

/// Reads what the line tells of a fix besides its accuracy. @return false: the line is no fix
bool CsvRecords::read_details(GeodeticFix& fix) {
  if (bound_.quality != nullptr) {
    const std::string_view field = fields_[bound_.quality->field];
    const std::optional<TableQuality> told = table_quality(field, bound_.quality->unit);
    if (!told) {
      if (strange_qualities_++ == 0) strange_quality_ = quote_field(field);
    } else if (told->no_fix) {
      ++data_.without_fix;
      return false;
    } else {
      fix.told.quality = told->quality;
    }
  }
  fix.told.hdop = optional_sigma(bound_.hdop).value_or(0);
  fix.told.satellites =
      static_cast<int>(std::clamp(optional_number(bound_.satellites).value_or(-1), -1.0, 999.0));
  fix.told.correction_age_s = number(bound_.correction_age, false);
  return true;
}

/// Some logs have -1 for a speed or a course that is not known: read as reversing, it spoils the drive.
void CsvRecords::take_out_unknown() {
  for (const UnknownMarks* marks : {&unknown_speed_, &unknown_course_}) {
    if (!marks->found()) continue;
    const BoundColumn& column = marks->column();
    const std::size_t count = take_out_marks(*marks, request_, data_);
    if (count > 0)
      data_.notes.push_back(fmt::format(
          "{}: {} values of {} are -1 {}, and no other one is negative: they are taken as not known (as 'missing: "
          "-1' of the column says; 'missing' with another number keeps them)",
          path_, count, column.quantity->name, column.unit));
  }
}

void CsvRecords::finish() {
  take_out_unknown();
  if (unwanted_ > 0)
    data_.notes.push_back(fmt::format("{}: {} rows are left out by 'where'", path_, unwanted_));
  if (wraps_.falls() > 0)
    data_.notes.push_back(fmt::format(
        "{}: the times are those of a counter of 32 bits: {} of its ends (2^32 {}) {} in the log, and they go on",
        path_, wraps_.falls(), bound_.time->unit, wraps_.falls() == 1 ? "is" : "are"));
  if (strange_qualities_ > 0)
    data_.notes.push_back(fmt::format(
        "{}: {} values of quality, such as {}, are none that is known (words, or numbers of the unit gga, rtklib "
        "or ros); these fixes count as of unknown quality",
        path_, strange_qualities_, strange_quality_));
  positions_.finish(data_);
}

void CsvRecords::read_readings(Stamp at) {
  row_.clear();
  for (std::size_t i = 0; i < request_.readings.size(); ++i)
    row_.push_back(readings_[i] == nullptr && composed_[i]
                       ? composed(composed_[i])
                       : number(readings_[i], request_.readings[i].required));
  if (complaint_.column != 0) return;
  data_.readings.stamps.push_back(at);
  data_.readings.values.insert(data_.readings.values.end(), row_.begin(), row_.end());
}

/// A time of day belongs to a date, and a date to no GPS week.
void CsvRecords::require_date(const std::string& path) const {
  const bool of_day = bound_.time != nullptr && bound_.time->unit == kTimeOfDay;
  if (bound_.date == nullptr && of_day && !request_.date)
    throw InputError(
        fmt::format("{}: time is a time of day: name the column of the date under columns, or state that of "
                    "the first row, 'time: {{date: 2024-01-31}}'",
                    path));
  if (bound_.date != nullptr && request_.gps_week != 0)
    throw InputError(fmt::format("{}: the log has a column of dates; leave out 'time: {{week: ...}}'", path));
}

/// Returns the instant in a column of times, on the scale of the request.
std::optional<Stamp> CsvRecords::instant(const BoundColumn& column) {
  std::string_view field = fields_[column.field];
  std::optional<std::string> plain;
  if (request_.separator != ',') plain = with_decimal_point(field);
  if (plain) field = *plain;
  const bool of_day = &column == bound_.time && (bound_.date != nullptr || column.unit == kTimeOfDay);
  // The usual case: a count of seconds.
  if (!of_day && column.form == UnitForm::number && column.time_power == 0)
    if (const std::optional<Stamp> stamp = stamp_from_decimal_seconds(field)) return stamp;
  const std::optional<TableInstant> told =
      of_day ? instant_of_day(column, field) : instant_from_field(field, column.unit, column.time_power);
  if (told) return told->scale ? convert(told->stamp, *told->scale, request_.time_scale) : told->stamp;
  complain(column, field.empty()
                       ? "no value"
                       : fmt::format("expected {}, got {}", expected_time(column.unit), quote_field(field)));
  return std::nullopt;
}

/// Adds the time of day, or the seconds of the day or week, to the date of the row or of the log.
std::optional<TableInstant> CsvRecords::instant_of_day(const BoundColumn& column, std::string_view field) {
  const std::optional<TableInstant> time = instant_from_field(field, column.unit, column.time_power);
  if (!time) return std::nullopt;
  if (bound_.date != nullptr) {
    const std::string_view date = fields_[bound_.date->field];
    const std::optional<TableInstant> begin = date_from_field(date, bound_.date->unit);
    if (!begin) {
      complain(*bound_.date,
               fmt::format("expected {}, got {}", expected_time(bound_.date->unit), quote_field(date)));
      return std::nullopt;
    }
    const std::int64_t length = begin->scale == TimeScale::gps ? kGpsWeekNanoseconds : kDayNanoseconds;
    if (column.form == UnitForm::number &&
        (time->stamp.nanoseconds < 0 || time->stamp.nanoseconds > length + kSecondNanoseconds)) {
      complain(column,
               fmt::format("{} is no time of the day or week that the date begins", quote_field(field)));
      return std::nullopt;
    }
    return TableInstant{Stamp{begin->stamp.nanoseconds + time->stamp.nanoseconds}, begin->scale};
  }
  constexpr std::int64_t kHalfDay = kDayNanoseconds / 2;
  if (last_of_day_.nanoseconds - time->stamp.nanoseconds > kHalfDay) ++days_;
  last_of_day_ = time->stamp;
  return TableInstant{Stamp{request_.date->nanoseconds + days_ * kDayNanoseconds + time->stamp.nanoseconds},
                      TimeScale::utc};
}

std::optional<Stamp> CsvRecords::stamp() {
  std::optional<Stamp> stamp = instant(*bound_.time);
  if (!stamp) return std::nullopt;
  const std::string_view field = fields_[bound_.time->field];
  if (request_.gps_week != 0 && (stamp->nanoseconds < 0 || stamp->nanoseconds >= 2 * kGpsWeekNanoseconds)) {
    complain(*bound_.time, fmt::format("{} is no second of a week", quote_field(field)));
    return std::nullopt;
  }
  if (bound_.time_fraction != nullptr && !add_fraction(*stamp)) return std::nullopt;
  if (request_.time_scale == TimeScale::gps && bound_.date == nullptr) stamp = weeks_.continued(*stamp);
  if (__builtin_add_overflow(stamp->nanoseconds, wraps_.added_ns(), &stamp->nanoseconds) ||
      __builtin_add_overflow(stamp->nanoseconds, offset_, &stamp->nanoseconds)) {
    complain(*bound_.time, fmt::format("{} is too large for a stamp", quote_field(field)));
    return std::nullopt;
  }
  return stamp;
}

/// Adds the fraction of the second that has a column of its own. @return false: it has none
bool CsvRecords::add_fraction(Stamp& stamp) {
  const BoundColumn& column = *bound_.time_fraction;
  const std::string_view field = fields_[column.field];
  const std::optional<TableInstant> told = instant_from_field(field, column.unit, column.time_power);
  if (told && !__builtin_add_overflow(stamp.nanoseconds, told->stamp.nanoseconds, &stamp.nanoseconds))
    return true;
  complain(column, field.empty() ? "no value" : fmt::format("expected a number, got {}", quote_field(field)));
  return false;
}

double CsvRecords::composed(Composed& way) {
  return way.value([this](const BoundColumn* column) { return number(column, false); });
}

std::optional<double> CsvRecords::optional_value(const BoundColumn* column, Composed& way) {
  if (column != nullptr || !way) return optional_number(column);
  const double value = composed(way);
  return std::isnan(value) ? std::nullopt : std::optional(value);
}

/// Returns the number of a field in its unit; NaN: it has none. Empty: it is none.
std::optional<double> CsvRecords::given_number(const BoundColumn& column, std::string_view field) const {
  if (column.form == UnitForm::number) return number_from_field(field, request_.separator);
  const std::optional<double> plain = number_from_field(field, request_.separator);
  if (column.form == UnitForm::text)
    return plain && std::isnan(*plain) ? plain : angle_from_field(field, column.unit);
  return plain ? std::copysign(std::sqrt(std::abs(*plain)), *plain) : plain;
}

/// Tells whether a field holds the number that means "no value".
bool CsvRecords::is_missing(const BoundColumn& column, std::string_view field) const {
  return column.missing && number_from_field(field, request_.separator) == column.missing;
}

double CsvRecords::number(const BoundColumn* column, bool required) {
  if (column == nullptr) return kNoNumber;
  const std::string_view field = fields_[column->field];
  std::optional<double> given = given_number(*column, field);
  if (!given && (column == bound_.latitude || column == bound_.longitude))
    given = angle_from_field(field, column->unit);
  if (!given) {
    const bool comma = field.find(',') != std::string_view::npos;
    complain(*column, fmt::format("expected a number{}, got {}", comma ? " with a decimal point" : "",
                                  quote_field(field)));
    return kNoNumber;
  }
  if (std::isnan(*given) || is_missing(*column, field)) {
    if (required) complain(*column, "no value");
    return kNoNumber;
  }
  if (request_.is_live &&
      (unknown_speed_.is_mark_so_far(column, *given) || unknown_course_.is_mark_so_far(column, *given)))
    return kNoNumber;
  unknown_speed_.see(column, *given);
  unknown_course_.see(column, *given);
  const Quantity& quantity = *column->quantity;
  // the range is for the given angle, before any offset
  const double scaled = column->factor * *given;
  if (scaled < quantity.smallest || scaled > quantity.largest) {
    constexpr double kMinutes = 100;  // ddmm.mmmm has at least three digits beyond one degree
    const bool is_place = column == bound_.latitude || column == bound_.longitude;
    complain(*column, fmt::format("{} {} is outside {:.6g} .. {:.6g}{}", quote_field(field), column->unit,
                                  quantity.smallest / std::abs(column->factor),
                                  quantity.largest / std::abs(column->factor),
                                  is_place && column->unit == "deg" && std::abs(*given) >= kMinutes
                                      ? "; if these are NMEA's degrees and minutes, state 'unit: ddmm'"
                                      : ""));
    return kNoNumber;
  }
  return scaled + column->offset;
}

/// Returns a latitude or longitude, with the sign of the hemisphere in a column of its own.
double CsvRecords::angle(const BoundColumn* column, const BoundColumn* hemisphere) {
  const double size = number(column, false);
  if (hemisphere == nullptr || std::isnan(size)) return size;
  const std::string_view field = fields_[hemisphere->field];
  const std::optional<double> sign = hemisphere_from_field(field);
  if (!sign) {
    complain(*hemisphere, fmt::format("expected N, S, E or W, got {}", quote_field(field)));
    return kNoNumber;
  }
  return *sign * std::abs(size);
}

std::optional<double> CsvRecords::optional_number(const BoundColumn* column) {
  const double value = number(column, false);
  return std::isnan(value) ? std::nullopt : std::optional(value);
}

std::optional<double> CsvRecords::optional_sigma(const BoundColumn* column) {
  const double value = number(column, false);
  return value > 0 ? std::optional(value) : std::nullopt;
}

/// Tells whether the receiver marks the line as a fix.
bool CsvRecords::has_fix() {
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

/// Returns the position of the line. Empty: it has none, or it is corrupt.
std::optional<CsvRecords::Position> CsvRecords::position() {
  if (bound_.ecef_x != nullptr) return position_in_space();
  const bool metric = bound_.easting != nullptr;
  const BoundColumn* first_column = metric ? bound_.easting : bound_.latitude;
  const BoundColumn* second_column = metric ? bound_.northing : bound_.longitude;
  const double first = angle(first_column, metric ? nullptr : bound_.latitude_hemisphere);
  const double second = angle(second_column, metric ? nullptr : bound_.longitude_hemisphere);
  if (complaint_.column != 0) return std::nullopt;
  if (std::isnan(first) && std::isnan(second)) {
    ++data_.without_fix;
    return std::nullopt;
  }
  if (std::isnan(first) || std::isnan(second)) {
    complain(std::isnan(first) ? *first_column : *second_column, "no value");
    return std::nullopt;
  }
  if (metric) return position_on_grid(first, second);
  return Position{first, second, {}};
}

/// Returns an Earth-centred position on the ellipsoid. Some receivers write zeros where they have none.
std::optional<CsvRecords::Position> CsvRecords::position_in_space() {
  const Eigen::Vector3d ecef(number(bound_.ecef_x, false), number(bound_.ecef_y, false),
                             number(bound_.ecef_z, false));
  if (complaint_.column != 0) return std::nullopt;
  if (ecef.array().isNaN().any() || ecef.isZero()) {
    ++data_.without_fix;
    return std::nullopt;
  }
  constexpr double kLowest = 6.3e6;
  constexpr double kHighest = 6.5e6;
  if (ecef.norm() < kLowest || ecef.norm() > kHighest) {
    complain(
        *bound_.ecef_x,
        fmt::format(
            "{}, {}, {} m are {:.6g} km from the centre of the Earth, and the ground is 6357 to 6384 km from it",
            ecef.x(), ecef.y(), ecef.z(), ecef.norm() / 1000));
    return std::nullopt;
  }
  const GeodeticPlace place = geodetic_from_ecef(ecef);
  return Position{place.latitude_deg, place.longitude_deg, {}, place.height_m};
}

/// Returns the height in its own column, else that of the position.
double CsvRecords::height_at(const Position& place) {
  return bound_.height != nullptr ? number(bound_.height, false) : place.height_m;
}

std::optional<CsvRecords::Position> CsvRecords::position_on_grid(double easting_m, double northing_m) {
  if (request_.local_origin) {
    if (const auto place = place_on_plane({easting_m, northing_m}, *request_.local_origin))
      return Position{place->latitude_deg, place->longitude_deg, place->axes};
    complain(*bound_.easting,
             fmt::format("{}, {} m are 1000 km from the origin or more", easting_m, northing_m));
    return std::nullopt;
  }
  const Frame& frame = *request_.metric_frame;
  const Eigen::Vector2d grid(easting_m + frame.origin_easting_m, northing_m + frame.origin_northing_m);
  const std::optional<UtmPlace> place = utm_from_grid(grid, frame.zone, frame.north);
  // The way back has a border of its own, and the drive takes it.
  if (place && utm_from_geodetic(place->latitude_deg, place->longitude_deg, frame.zone, frame.north))
    return Position{place->latitude_deg, place->longitude_deg, place->axes};
  complain(*bound_.easting,
           fmt::format("UTM easting {}, northing {} are outside zone {}", grid.x(), grid.y(), frame.zone));
  return std::nullopt;
}

void CsvRecords::set_covariance(GeodeticFix& fix, const GridAxes& axes) {
  const double east = number(accuracy_east_, false);
  const double north = accuracy_north_ == accuracy_east_ ? east : number(accuracy_north_, false);
  const double root = number(covariance_root_, false);
  if (complaint_.column != 0) return;
  StatedAccuracy accuracy = table_accuracy(east, north, root, accuracy_);
  if (accuracy.squares_en) accuracy.squares_en = covariance_from_grid(*accuracy.squares_en, axes);
  const char* what = positions_.set_covariance(fix, accuracy);
  if (what == nullptr) return;
  const bool root_is_wrong = east > 0 && north > 0 && covariance_root_ != nullptr;
  complain(*(root_is_wrong ? covariance_root_ : east > 0 ? accuracy_north_ : accuracy_east_), what);
}

void CsvRecords::complain(const BoundColumn& column, std::string what) {
  if (complaint_.column != 0) return;
  complaint_ = {column_of(line_, fields_[column.field]), fmt::format("{}: {}", column.quantity->name, what)};
}

}  // namespace waymark::formats
