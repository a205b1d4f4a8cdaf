#include <waymark/formats/logs/detail/can/can_signals.hpp>

#include <algorithm>
#include <array>
#include <optional>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/suggest.hpp>
#include <waymark/formats/logs/detail/common/unit_words.hpp>
#include <waymark/formats/logs/detail/csv/csv_columns.hpp>

namespace waymark::formats {
namespace {

/// A message lists at most this many signals.
constexpr std::size_t kMostListed = 12;

/// Lists the first few names in a message.
std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < kMostListed; ++i) text += (i == 0 ? "" : ", ") + names[i];
  if (names.size() > kMostListed) text += fmt::format(" and {} more", names.size() - kMostListed);
  return text;
}

/// Returns signals with names that resemble the quantities of the stream.
std::vector<std::string> likely_signals(const Dbc& dbc, StreamKind stream) {
  constexpr std::array<std::string_view, 7> kPosition{"latitude", "longitude", "lat_",    "lon_",
                                                      "heading",  "course",    "altitude"};
  constexpr std::array<std::string_view, 6> kMotion{"speed", "yaw", "wheel", "steer", "gyro", "accel"};
  const bool position = stream == StreamKind::gnss || stream == StreamKind::truth;
  const std::span<const std::string_view> words =
      position ? std::span<const std::string_view>(kPosition) : std::span<const std::string_view>(kMotion);
  std::vector<std::string> names;
  const bool of_file = !dbc.messages.front().is_standard;
  for (const DbcMessage& message : dbc.messages) {
    if (of_file && message.is_standard) continue;
    for (const DbcSignal& signal : message.signals) {
      const std::string name = lower_case(signal.name);
      for (const std::string_view word : words) {
        if (name.find(word) == std::string::npos) continue;
        names.push_back(message.name + "." + signal.name);
        break;
      }
    }
  }
  return names;
}

void note_troubles(const Dbc& dbc, const std::string& place, std::vector<std::string>& notes) {
  std::size_t count = 0;
  std::string first;
  for (const DbcMessage& message : dbc.messages) {
    for (const DbcSignal& signal : message.signals) {
      if (signal.trouble.empty()) continue;
      if (count == 0) first = signal.trouble;
      ++count;
    }
  }
  if (count > 0)
    notes.push_back(
        fmt::format("{}{} signals of the DBC are unreadable (no column uses "
                    "them); the first: {}",
                    place, count, first));
}

class Binder {
 public:
  Binder(const Dbc& dbc, const LogRequest& request, const std::string& place, std::vector<std::string>& notes)
      : dbc_(dbc), request_(request), place_(place), notes_(notes) {}

  void check_request(const std::vector<Quantity>& quantities) const;
  [[nodiscard]] BoundSignal bind(const Quantity& quantity, const ColumnRequest& wanted);
  /// Notes the units that nobody stated.
  void note_units() const {
    if (!by_dbc_.empty()) notes_.push_back(fmt::format("{}units by the DBC: {}", place_, by_dbc_));
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InputError(place_ + what); }
  void find(const Quantity& quantity, std::string_view column, BoundSignal& bound) const;
  [[nodiscard]] const Unit& unit_of(const Quantity& quantity, const ColumnRequest& wanted,
                                    const DbcSignal& signal);

  const Dbc& dbc_;
  const LogRequest& request_;
  const std::string& place_;
  std::vector<std::string>& notes_;
  std::string by_dbc_;
};

void Binder::check_request(const std::vector<Quantity>& quantities) const {
  const std::vector<std::string_view> known = names_of(quantities);
  for (const auto& [name, wanted] : request_.columns) {
    const Quantity* quantity = find_quantity(quantities, name);
    if (quantity == nullptr && name == "time")
      fail(
          "frames of a candump log are stamped by the logger, so no signal can be their 'time'; map "
          "the receiver's clock as gnss_time, which gives the logger's offset");
    if (quantity == nullptr)
      fail(fmt::format("'{}' is no quantity of the {} stream{}", name, to_string(request_.stream),
                       suggestion(name, known)));
    if (const std::string error = column_request_error(*quantity, wanted); !error.empty()) fail(error);
  }
  std::string missing;
  for (const Quantity& quantity : quantities) {
    const bool needed = request_.columns.empty() || quantity.required;
    if (needed && !request_.columns.contains(std::string(quantity.name)))
      missing = missing.empty() ? std::string(quantity.name) : missing;
  }
  if (missing.empty()) return;
  const std::vector<std::string> likely = likely_signals(dbc_, request_.stream);
  fail(fmt::format("no signal for {}: state 'columns: {{{}: SIGNAL}}'; {}", missing, missing,
                   likely.empty() ? fmt::format("no name of a signal in {} suggests it", dbc_.path)
                                  : fmt::format("{} has {}", dbc_.path, listed(likely))));
}

BoundSignal Binder::bind(const Quantity& quantity, const ColumnRequest& wanted) {
  BoundSignal bound;
  find(quantity, wanted.column, bound);
  const DbcMessage& message = dbc_.messages[bound.message];
  const DbcSignal& signal = message.signals[bound.signal];
  if (!signal.trouble.empty()) fail(fmt::format("{}: {}", quantity.name, signal.trouble));
  if (signal.bytes_needed() > kMostFrameBytes)
    fail(fmt::format(
        "{}: {}.{} is behind the first 64 bytes, so its message takes several frames (a transport "
        "protocol), which are not read",
        quantity.name, message.name, signal.name));
  const Unit& unit = unit_of(quantity, wanted, signal);
  const Convention& convention = *find_convention(quantity, wanted.convention);
  if (quantity.name == "gnss_time") {
    bound.time_power = static_cast<int>(unit.factor);
    return bound;
  }
  bound.factor = convention.sign * unit.factor * wanted.scale;
  bound.offset = convention.offset;
  bound.missing = wanted.missing;
  return bound;
}

/// Finds message and signal by name.
void Binder::find(const Quantity& quantity, std::string_view column, BoundSignal& bound) const {
  if (const std::size_t colon = column.find(':'); colon != std::string_view::npos) {
    bound.interface = column.substr(0, colon);
    column.remove_prefix(colon + 1);
  }
  const std::size_t point = column.find('.');
  const bool has_message = point != std::string_view::npos;
  const std::string_view message_name = has_message ? column.substr(0, point) : std::string_view();
  const std::string_view signal_name = has_message ? column.substr(point + 1) : column;
  std::vector<std::string> found;
  std::vector<std::string_view> messages;
  std::vector<std::string_view> signals;
  for (std::size_t i = 0; i < dbc_.messages.size(); ++i) {
    const DbcMessage& message = dbc_.messages[i];
    messages.push_back(message.name);
    if (has_message && message.name != message_name) continue;
    for (std::size_t j = 0; j < message.signals.size(); ++j) {
      if (!message.is_standard || dbc_.messages.front().is_standard)
        signals.push_back(message.signals[j].name);
      if (message.signals[j].name != signal_name) continue;
      if (message.is_standard && !found.empty()) continue;  // a DBC file comes first
      bound.message = i;
      bound.signal = j;
      found.push_back(message.name + "." + message.signals[j].name);
    }
  }
  if (found.size() == 1) return;
  if (found.size() > 1)
    fail(fmt::format("{}: '{}' is a signal of several messages; name one: {}", quantity.name, signal_name,
                     listed(found)));
  if (has_message && signals.empty())
    fail(fmt::format("{}: {} has no message '{}'{}", quantity.name, dbc_.path, message_name,
                     did_you_mean(message_name, messages)));
  fail(fmt::format("{}: {} has no signal '{}'{}", quantity.name,
                   has_message ? std::string(message_name) : dbc_.path, signal_name,
                   did_you_mean(signal_name, signals)));
}

const Unit& Binder::unit_of(const Quantity& quantity, const ColumnRequest& wanted, const DbcSignal& signal) {
  const std::string_view by_dbc = known_unit(signal.unit);
  std::vector<std::string_view> units;
  for (const Unit& known : quantity.units) {
    if (known.form == UnitForm::number) units.push_back(known.name);
  }
  if (!wanted.unit.empty()) {
    const Unit& stated = *find_unit(quantity, wanted.unit);
    if (stated.form != UnitForm::number)
      fail(fmt::format("{}: a signal is a number, never in '{}'; its units are {}", quantity.name,
                       stated.name, joined(units)));
    if (!by_dbc.empty() && by_dbc != wanted.unit)
      notes_.push_back(
          fmt::format("{}{}: signal {} is read in '{}' as stated, though by the DBC it is in '{}'", place_,
                      quantity.name, signal.name, wanted.unit, signal.unit));
    return stated;
  }
  const Unit& own = quantity.units.front();
  if (own.name == "1") return own;  // flags and counts
  const Unit* unit = by_dbc.empty() ? nullptr : find_unit(quantity, by_dbc);
  if (unit != nullptr && unit != &own && wanted.scale != 1)
    fail(fmt::format(
        "{}: signal {} has a scale, and by the DBC it is in '{}': state the unit of the scaled value, {}",
        quantity.name, signal.name, signal.unit, joined(units)));
  if (unit == nullptr && wanted.scale != 1) return own;
  if (unit != nullptr) {
    by_dbc_ +=
        fmt::format("{}{} '{}' ({})", by_dbc_.empty() ? "" : ", ", quantity.name, signal.unit, signal.name);
    return *unit;
  }
  fail(fmt::format("{}: signal {} is {}; state 'unit' for it: {}", quantity.name, signal.name,
                   signal.unit.empty() ? "without a unit in the DBC"
                                       : fmt::format("in '{}' by the DBC, which is not a unit of {}",
                                                     signal.unit, quantity.name),
                   joined(units)));
}

}  // namespace

std::vector<Quantity> signal_quantities(const LogRequest& request) {
  if (request.stream == StreamKind::odometry && request.readings.empty())
    throw UsageError("a CAN log gives odometry in channels: LogRequest::readings must name them");
  std::vector<Quantity> result = quantities(request);
  constexpr std::array<std::string_view, 6> kOfTables{
      "time", "date", "easting", "northing", "latitude_hemisphere", "longitude_hemisphere"};
  std::erase_if(result, [&kOfTables](const Quantity& quantity) {
    return std::find(kOfTables.begin(), kOfTables.end(), quantity.name) != kOfTables.end();
  });
  return result;
}

std::vector<BoundSignal> bind_signals(const Dbc& dbc, const std::vector<Quantity>& quantities,
                                      const LogRequest& request, const std::string& place,
                                      std::vector<std::string>& notes) {
  Binder binder(dbc, request, place, notes);
  binder.check_request(quantities);
  note_troubles(dbc, place, notes);
  std::vector<BoundSignal> result;
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    const auto wanted = request.columns.find(std::string(quantities[i].name));
    if (wanted == request.columns.end()) continue;
    result.push_back(binder.bind(quantities[i], wanted->second));
    result.back().quantity = i;
  }
  binder.note_units();
  return result;
}

}  // namespace waymark::formats
