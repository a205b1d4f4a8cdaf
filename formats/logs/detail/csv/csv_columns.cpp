#include <waymark/formats/logs/detail/csv/csv_columns.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/suggest.hpp>
#include <waymark/formats/logs/detail/common/record_fields.hpp>
#include <waymark/formats/logs/detail/csv/composed.hpp>
#include <waymark/formats/logs/detail/csv/table_header.hpp>
#include <waymark/formats/text/detail/line_scanner.hpp>
#include <waymark/formats/text/iso8601.hpp>
#include <waymark/formats/text/stamp_text.hpp>

namespace waymark::formats {
namespace {

/// Returns the number of a column that is given by number; empty for a name.
std::optional<std::size_t> column_number(std::string_view column) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(column.data(), column.data() + column.size(), number);
  if (error != std::errc() || end != column.data() + column.size()) return std::nullopt;
  return number;
}

template <typename Item>
std::vector<std::string_view> names_of(std::span<const Item> items) {
  std::vector<std::string_view> names;
  for (const Item& item : items) names.push_back(item.name);
  return names;
}

std::vector<std::string_view> views_of(const std::vector<std::string>& names) {
  return {names.begin(), names.end()};
}

/// Tells whether the first line of a table already holds values. It does if all fields are numbers,
/// or if the time column is given by number and its field is a time (or a number, in another unit).
/// The second rule is for headerless tables with dates and words.
bool holds_values(const std::vector<std::string_view>& fields, const LogRequest& request) {
  const auto is_number = [&](std::string_view field) {
    return number_from_field(field, request.separator).has_value();
  };
  if (std::all_of(fields.begin(), fields.end(), is_number)) return true;
  const auto time = request.columns.find("time");
  if (time == request.columns.end()) return false;
  const std::size_t number = column_number(time->second.column).value_or(0);
  if (number < 1 || number > fields.size()) return false;
  const std::string_view field = fields[number - 1];
  const std::optional<double> value = number_from_field(field, request.separator);
  return (value && !std::isnan(*value)) || stamp_from_decimal_seconds(field) || stamp_from_iso8601(field);
}

/// Returns what is wrong with the scale or the number for "no value" of a request. Empty: nothing.
std::string number_error(const Quantity& quantity, const ColumnRequest& request) {
  if (!std::isfinite(request.scale) || request.scale == 0)
    return fmt::format("the scale of {} is {}; expected a number other than 0", quantity.name, request.scale);
  if (request.missing && !std::isfinite(*request.missing))
    return fmt::format("'missing' of {} is {}; expected a number", quantity.name, *request.missing);
  const bool is_text = find_unit(quantity, request.unit)->form == UnitForm::text;
  if (request.scale != 1 && (is_text || !has_size(quantity)))
    return fmt::format("{}{} is no number that a scale could multiply; leave out 'scale'", quantity.name,
                       is_text && !request.unit.empty() ? fmt::format(" in {}", request.unit) : "");
  if (request.missing && !has_size(quantity))
    return fmt::format("{} is no number of which one could mean no value; leave out 'missing'",
                       quantity.name);
  return {};
}

/// Returns the default name of a quantity that several columns have; empty: none is.
std::string_view name_given_twice(const Quantity& quantity, const std::vector<std::string>& names) {
  for (const std::string_view name : {quantity.name, quantity.default_column})
    if (!quantity.by_request && std::count(names.begin(), names.end(), name) > 1) return name;
  return {};
}

/// Returns the place of the letter or word that makes a plain name that of a component to the east or north:
/// "vel_east", "velnorth", "ve", "v_n"; npos: it is none.
std::size_t component_word(std::string_view name) {
  for (const std::string_view word : {"east", "north"})
    if (const std::size_t at = name.find(word); at != std::string_view::npos) return at;
  constexpr std::array<std::string_view, 4> kBegins{"v", "v_", "vel_", "velocity_"};
  if (name.empty() || (name.back() != 'e' && name.back() != 'n')) return std::string_view::npos;
  const bool is_component =
      std::find(kBegins.begin(), kBegins.end(), name.substr(0, name.size() - 1)) != kBegins.end();
  return is_component ? name.size() - 1 : std::string_view::npos;
}

/// @pre the name is that of a component
bool names_east(std::string_view name) {
  return name[component_word(name)] == 'e';
}

/// Returns the plain name of the component across this one; empty if it is none.
std::optional<std::string> other_component(std::string_view name) {
  const std::size_t at = component_word(name);
  if (at == std::string_view::npos) return std::nullopt;
  const bool is_letter = at + 1 == name.size();
  const std::string_view word = is_letter ? name.substr(at) : names_east(name) ? "east" : "north";
  const std::string_view other = is_letter ? (word == "e" ? "n" : "e") : (word == "east" ? "north" : "east");
  return std::string(name.substr(0, at)).append(other).append(name.substr(at + word.size()));
}

bool is_default_name(const Quantity& quantity, std::string_view name) {
  return name == quantity.name || name == lower_case(quantity.default_column);
}

}  // namespace

std::optional<std::string> with_decimal_point(std::string_view field) {
  const std::size_t comma = field.find(',');
  if (comma == std::string_view::npos ||
      field.find_first_not_of("+-0123456789,eE") != std::string_view::npos ||
      field.find(',', comma + 1) != std::string_view::npos)
    return std::nullopt;
  std::string text(field);
  text[comma] = '.';
  return text;
}

std::optional<double> number_from_field(std::string_view field, char separator) {
  if (field.empty()) return kNoNumber;
  if (const std::optional<double> value = field_number(field)) return value;
  if (separator != ',')
    if (const std::optional<std::string> plain = with_decimal_point(field)) return field_number(*plain);
  const std::string word = lower_case(field);
  for (const std::string_view none : {"nan", "na", "n/a", "null", "none"}) {
    if (word == none) return kNoNumber;
  }
  return std::nullopt;
}

std::string column_request_error(const Quantity& quantity, const ColumnRequest& request) {
  if (request.column.empty()) return fmt::format("no column is given for {}", quantity.name);
  if (find_unit(quantity, request.unit) == nullptr) {
    const std::vector<std::string_view> known = names_of(quantity.units);
    return fmt::format("unknown unit '{}' for {}{}; known: {}", request.unit, quantity.name,
                       did_you_mean(request.unit, known), joined(known));
  }
  if (find_convention(quantity, request.convention) != nullptr) return number_error(quantity, request);
  if (quantity.conventions.empty()) return fmt::format("{} has no convention; leave it out", quantity.name);
  const std::vector<std::string_view> known = names_of(quantity.conventions);
  return fmt::format("unknown convention '{}' for {}{}; known: {}", request.convention, quantity.name,
                     did_you_mean(request.convention, known), joined(known));
}

CsvColumns::CsvColumns(const TableLine& first, const std::string& path, const LogRequest& request)
    : quantities_(table_quantities(request)) {
  check_request(path + ": ", request);
  find_header(first, path, request);
  const std::string place = fmt::format("{}:{}:1: ", path, first.number);
  if (request.where) filtered_ = field_stated(request.where->column, "where", place);
  choose_position(request, place);
  const std::size_t before = notes_.size();
  for (const Quantity& quantity : quantities_) {
    const auto wanted = request.columns.find(std::string(quantity.name));
    bind(quantity, wanted == request.columns.end() ? nullptr : &wanted->second, place);
  }
  if (!by_default_.empty())
    notes_.insert(notes_.begin() + static_cast<std::ptrdiff_t>(before),
                  fmt::format("{}columns by their default names: {}", place, joined(by_default_)));
  const bool in_channels = request.stream != StreamKind::sensor && !request.readings.empty();
  if (in_channels && columns_.size() == 1)
    throw InputError(fmt::format("{}no column for {} or another channel: name it under columns{}", place,
                                 request.readings.front().name, columns_present()));
}

void CsvColumns::check_request(const std::string& place, const LogRequest& request) const {
  const std::vector<std::string_view> known = names_of(quantities_);
  for (const auto& [name, wanted] : request.columns) {
    const Quantity* quantity = find_quantity(quantities_, name);
    if (quantity == nullptr)
      throw InputError(fmt::format("{}'{}' is no quantity of the {} stream{}", place, name,
                                   to_string(request.stream), suggestion(name, known)));
    if (const std::string error = column_request_error(*quantity, wanted); !error.empty())
      throw InputError(place + error);
  }
}

void CsvColumns::find_header(const TableLine& first, const std::string& path, const LogRequest& request) {
  std::vector<std::string_view> fields;
  if (!split_fields(first.text, request.separator, fields))
    throw InputError(fmt::format("{}:{}:1: a quoted field of the header is not closed", path, first.number));
  field_count_ = fields.size();
  if (!holds_values(fields, request)) {
    take_names(fields);
    first_line_is_header_ = true;
    if (!first.units_below.empty() && split_fields(first.units_below, request.separator, fields))
      take_units(fields);
    return;
  }
  std::vector<std::string_view> comment;
  if (first.comment_above.empty() || !split_fields(first.comment_above, request.separator, comment)) return;
  if (comment.size() != fields.size()) return;
  take_names(comment);
  notes_.push_back(
      fmt::format("{}: column names were taken from the comment above line {}", path, first.number));
}

void CsvColumns::take_names(const std::vector<std::string_view>& names) {
  names_.assign(names.begin(), names.end());
  for (const std::string_view name : names) {
    plain_names_.push_back(plain_name(name));
    units_.push_back(unit_in_name(name));
  }
}

void CsvColumns::take_units(const std::vector<std::string_view>& row) {
  strange_units_.resize(names_.size());
  for (std::size_t i = 0; i < std::min(row.size(), names_.size()); ++i) {
    const std::string_view unit = unit_in_row(row[i]);
    if (!unit.empty()) units_[i] = unit;
    if (unit.empty() && row[i].size() > 1) strange_units_[i] = row[i];
  }
}

/// Keeps the quantities of one kind of position: latitude and longitude, easting and northing, or ECEF.
void CsvColumns::choose_position(const LogRequest& request, const std::string& place) {
  if (find_quantity(quantities_, "easting") == nullptr) return;
  const auto states = [&](std::string_view first, std::string_view second) {
    return request.columns.contains(std::string(first)) || request.columns.contains(std::string(second));
  };
  const bool states_degrees = states("latitude", "longitude");
  const bool states_metres = states("easting", "northing");
  const bool states_ecef = states("ecef_x", "ecef_y") || request.columns.contains("ecef_z");
  if (states_degrees + states_metres + states_ecef > 1)
    throw InputError(
        place +
        "columns name two kinds of position: keep latitude and longitude, easting and northing, or "
        "ecef_x, ecef_y and ecef_z");
  if (states_ecef) return keep_ecef();
  const bool metric = states_metres || (!states_degrees && !has_default_columns("latitude", "longitude") &&
                                        has_default_columns("easting", "northing"));
  if (metric && !request.local_origin && request.metric_frame.value_or(Frame{}).zone == 0)
    throw InputError(place +
                     "easting and northing are coordinates of a stated frame: the log needs "
                     "'frame: {utm_zone: 32N}' or 'frame: {enu_origin: [LATITUDE, LONGITUDE]}'");
  std::erase_if(quantities_, [metric](const Quantity& quantity) {
    const bool degrees = quantity.name == "latitude" || quantity.name == "longitude";
    const bool metres = quantity.name == "easting" || quantity.name == "northing";
    return metric ? degrees : metres;
  });
  for (Quantity& quantity : quantities_)
    quantity.required = quantity.required || quantity.name == "easting" || quantity.name == "northing";
}

void CsvColumns::keep_ecef() {
  std::erase_if(quantities_, [](const Quantity& quantity) {
    return quantity.name.starts_with("latitude") || quantity.name.starts_with("longitude") ||
           quantity.name == "easting" || quantity.name == "northing";
  });
  for (Quantity& quantity : quantities_)
    quantity.required = quantity.required || quantity.name.starts_with("ecef_");
}

bool CsvColumns::has_default_columns(std::string_view first, std::string_view second) const {
  const auto has = [&](std::string_view name) {
    const Quantity& quantity = *find_quantity(quantities_, name);
    return std::any_of(names_.begin(), names_.end(), [&](const std::string& field) {
      return is_default_name(quantity, plain_name(field));
    });
  };
  return has(first) && has(second);
}

/// @throws InputError if two columns have the name: nobody can tell which is meant
void CsvColumns::require_one(std::string_view name, std::string_view use, const std::string& place) const {
  if (std::count(names_.begin(), names_.end(), name) > 1)
    throw InputError(fmt::format("{}the header has '{}' {} times; name the column of {} by its number", place,
                                 shown_name(name), std::count(names_.begin(), names_.end(), name), use));
}

/// Returns the field of a column that the request names. @param use what it is wanted for, for messages
std::optional<std::size_t> CsvColumns::field_stated(const std::string& column, std::string_view use,
                                                    const std::string& place) const {
  require_one(column, use, place);
  if (const auto field = field_named(column)) return field;
  if (const auto number = column_number(column)) {
    if (*number < 1 || *number > field_count_)
      throw InputError(fmt::format("{}no column {} for {}: the table has columns 1 to {}", place, *number,
                                   use, field_count_));
    return *number - 1;
  }
  throw InputError(fmt::format("{}no column '{}' for {}{}{}", place, column, use,
                               did_you_mean(column, views_of(shown_names())), columns_present()));
}

/// A component of a velocity is no speed.
/// @throws InputError if the table has the other one, too
void CsvColumns::require_no_component(std::size_t field, const std::string& place) const {
  if (field >= names_.size()) return;
  const std::optional<std::string> other = other_component(plain_names_[field]);
  const auto at = other ? std::find(plain_names_.begin(), plain_names_.end(), *other) : plain_names_.end();
  if (at == plain_names_.end()) return;
  const auto other_field = static_cast<std::size_t>(at - plain_names_.begin());
  const bool is_east = names_east(plain_names_[field]);
  throw InputError(fmt::format(
      "{}'{}' is a component of a velocity and no speed, and the table has the other one: state 'velocity_east: {}' "
      "and 'velocity_north: {}' in place of 'speed' (and of 'course')",
      place, shown_name(names_[field]), shown_name(names_[is_east ? field : other_field]),
      shown_name(names_[is_east ? other_field : field])));
}

void CsvColumns::bind(const Quantity& quantity, const ColumnRequest* wanted, const std::string& place) {
  BoundColumn bound;
  bound.quantity = &quantity;
  std::optional<std::size_t> field;
  if (wanted != nullptr) {
    field = field_stated(wanted->column, quantity.name, place);
    if (quantity.name == "speed") require_no_component(*field, place);
  } else {
    if (const std::string_view twice =
            quantity.required ? std::string_view() : name_given_twice(quantity, names_);
        !twice.empty()) {
      notes_.push_back(
          fmt::format("{}the header has '{}' several times: none is read unless its number is named", place,
                      shown_name(twice)));
      return;
    }
    field = field_by_default(quantity, place);
    if (!field && quantity.required)
      throw InputError(
          fmt::format("{}no column for {} ({}): name it under columns{}", place, quantity.name,
                      quantity.name == quantity.default_column
                          ? fmt::format("no '{}'", quantity.name)
                          : fmt::format("neither '{}' nor '{}'", quantity.name, quantity.default_column),
                      columns_present()));
    if (!field) return;
    const std::string& name = names_[*field];
    by_default_.push_back(name == quantity.name ? name
                                                : fmt::format("{} ('{}')", quantity.name, shown_name(name)));
  }
  const ColumnRequest plain;
  const ColumnRequest& how = wanted != nullptr ? *wanted : plain;
  const Unit& unit = unit_of(quantity, how, *field, place);
  const Convention& convention = *find_convention(quantity, how.convention);
  bound.field = *field;
  bound.unit = unit.name;
  bound.form = unit.form;
  // The root of a variance is taken before the factor.
  const double scale =
      unit.form == UnitForm::square ? std::copysign(std::sqrt(std::abs(how.scale)), how.scale) : how.scale;
  bound.factor = convention.sign * unit.factor * scale;
  bound.offset = convention.offset;
  bound.missing = how.missing;
  if (quantity.name == "time" || quantity.name == "gnss_time" || quantity.name == "time_fraction")
    bound.time_power = static_cast<int>(unit.factor);
  columns_.push_back(bound);
}

/// Returns the column that has a default name: exactly, or without its unit and in any letters.
/// @throws InputError if several columns have it
std::optional<std::size_t> CsvColumns::field_by_default(const Quantity& quantity,
                                                        const std::string& place) const {
  if (quantity.by_request) return std::nullopt;
  for (const std::string_view name : {quantity.name, quantity.default_column}) {
    if (const auto field = field_named(name)) {
      require_one(name, quantity.name, place);
      return field;
    }
  }
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < plain_names_.size(); ++i) {
    if (!is_default_name(quantity, plain_names_[i])) continue;
    if (found)
      throw InputError(fmt::format("{}'{}' and '{}' may both be {}; name the column under columns", place,
                                   shown_name(names_[*found]), shown_name(names_[i]), quantity.name));
    found = i;
  }
  return found;
}

/// Returns the unit of a column: as stated, or as the header has it. A scale alone gives the default unit.
/// @throws InputError if the row of units has a word that is no unit, and if the header has a unit beside a
/// scale alone: the scaled number may be in either
const Unit& CsvColumns::unit_of(const Quantity& quantity, const ColumnRequest& how, std::size_t field,
                                const std::string& place) {
  const std::string& stated = how.unit;
  const Unit& usual = *find_unit(quantity, stated);
  if (field >= units_.size() || quantity.units.size() < 2) return usual;
  const std::string_view strange = field < strange_units_.size() ? strange_units_[field] : std::string_view();
  if (stated.empty() && !strange.empty() && how.scale == 1)
    throw InputError(fmt::format("{}the row of units has {} for {}; state its unit under columns: {}", place,
                                 quote_field(strange), quantity.name, joined(names_of(quantity.units))));
  const std::string_view written = units_[field];
  if (written.empty() || written == usual.name) return usual;
  const Unit* of_header = find_unit(quantity, written);
  const bool obeyed = stated.empty() && of_header != nullptr;
  if (obeyed && how.scale != 1)
    throw InputError(fmt::format(
        "{}{} has a scale, and the header has {}: state the unit of the scaled number under columns, "
        "{} or another",
        place, quantity.name, written, usual.name));
  notes_.push_back(obeyed ? fmt::format("{}{} is in {} by the header", place, quantity.name, written)
                          : fmt::format("{}{} is read in {}, though the header has {}", place, quantity.name,
                                        usual.name, written));
  return obeyed ? *of_header : usual;
}

const BoundColumn* CsvColumns::find(std::string_view quantity) const {
  for (const BoundColumn& column : columns_) {
    if (column.quantity->name == quantity) return &column;
  }
  return nullptr;
}

std::optional<std::size_t> CsvColumns::field_named(std::string_view name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  if (found == names_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names_.begin());
}

std::string CsvColumns::columns_present() const {
  if (names_.empty()) return fmt::format("; the table has no header, only columns 1 to {}", field_count_);
  constexpr std::size_t kMostListed = 40;
  std::vector<std::string> shown = shown_names();
  const std::size_t more = shown.size() - std::min(shown.size(), kMostListed);
  shown.resize(shown.size() - more);
  return fmt::format("; columns present: {}{}", joined(views_of(shown)),
                     more > 0 ? fmt::format(" and {} more", more) : "");
}

/// Returns the names in the header as messages show them.
std::vector<std::string> CsvColumns::shown_names() const {
  std::vector<std::string> shown;
  for (const std::string& name : names_) shown.push_back(shown_name(name));
  return shown;
}

}  // namespace waymark::formats
