#include <waymark/formats/logs/detail/rinex/rinex_observations.hpp>

#include <algorithm>
#include <limits>
#include <span>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/common/gps_time.hpp>
#include <waymark/formats/logs/detail/common/record_fields.hpp>
#include <waymark/formats/text/detail/line_scanner.hpp>

namespace waymark::formats {
namespace {

constexpr std::size_t kWidth = 16;  // F14.3, loss of lock, signal strength
constexpr std::size_t kPerLine2 = 5;
constexpr std::size_t kNamesPerLine2 = 12;
constexpr std::size_t kLine2 = 80;
constexpr int kMostSatellites = 200;
constexpr std::size_t kMostTypes = 200;

std::optional<std::size_t> find_type(const std::vector<std::string>& types, std::string_view type) {
  const auto found = std::find(types.begin(), types.end(), type);
  if (found == types.end()) return std::nullopt;
  return static_cast<std::size_t>(found - types.begin());
}

RinexColumns columns_2(const std::vector<std::string>& types) {
  const auto range = find_type(types, "C1");
  return {range ? range : find_type(types, "P1"), find_type(types, "D1"), find_type(types, "S1")};
}

/// Signals of the first frequency, best first: the open code comes before encrypted ones.
std::span<const std::string_view> signals_3(char system) {
  static constexpr std::array<std::string_view, 8> kL1{"1C", "1S", "1L", "1X", "1W", "1P", "1Y", "1M"};
  static constexpr std::array<std::string_view, 2> kG1{"1C", "1P"};
  static constexpr std::array<std::string_view, 5> kE1{"1C", "1X", "1B", "1A", "1Z"};
  // B1I is 2I; RINEX 3.02 called it 1I.
  static constexpr std::array<std::string_view, 6> kB1{"2I", "2Q", "2X", "1I", "1Q", "1X"};
  if (system == 'R') return kG1;
  if (system == 'E') return kE1;
  if (system == 'C') return kB1;
  return kL1;
}

RinexColumns columns_3(char system, const std::vector<std::string>& types) {
  for (const std::string_view signal : signals_3(system)) {
    const std::string name(signal);
    const auto range = find_type(types, "C" + name);
    if (range) return {range, find_type(types, "D" + name), find_type(types, "S" + name)};
  }
  return {};
}

char letter_of(const satellites::SatelliteName& name) {
  return satellites::to_string(name)[0];
}

}  // namespace

void RinexObservations::fail(const std::string& what) const {
  throw InputError(fmt::format("{}:{}: {}", path_, number_, what));
}

void RinexObservations::complain(std::size_t column, const std::string& what) {
  listener_.corrupt(number_, column, what);
}

void RinexObservations::take_line(std::string_view line, std::size_t number) {
  line_ = line;
  number_ = number;
  switch (part_) {
    case Part::first_line:
      return take_first_line();
    case Part::header:
      return take_header_line();
    case Part::between:
      return take_epoch_line();
    case Part::names:
      return take_names();
    case Part::satellites:
      return take_satellite_line();
    case Part::event:
      take_header_line();
      if (part_ == Part::event && ++seen_ >= expected_) part_ = Part::between;
      return;
  }
}

void RinexObservations::finish() {
  if (part_ == Part::first_line || part_ == Part::header)
    throw InputError(
        fmt::format("{}: the file ends in its header, after {} lines; the receiver or the copy was cut off",
                    path_, number_));
  if (part_ == Part::names || part_ == Part::satellites)
    lose_epoch(fmt::format("the file ends after {} of {} satellites of the epoch of line {}", seen_,
                           expected_, epoch_line_));
}

void RinexObservations::take_first_line() {
  const auto version = rinex_version(line_);
  if (!version) fail("expected RINEX: its first line ends with 'RINEX VERSION / TYPE'");
  if (version->kind != 'O')
    fail("this is no observation file but a file of type '" + shown_name({&version->kind, 1}) +
         "'; name ephemerides with 'navigation', and the observations with 'file'");
  if (version->version < 2 || version->version >= 4)
    fail(fmt::format("RINEX {:.2f} is not read, only 2 and 3; RTKLIB's convbin or gfzrnx converts it",
                     version->version));
  version_ = *version;
  part_ = Part::header;
}

void RinexObservations::take_header_line() {
  const std::string_view label = rinex_label(line_);
  if (label == "END OF HEADER" && part_ == Part::header) {
    choose_columns();
    part_ = Part::between;
  } else if (label == "# / TYPES OF OBSERV") {
    take_types_2();
  } else if (label == "SYS / # / OBS TYPES") {
    take_types_3();
  } else if (label == "TIME OF FIRST OBS") {
    const std::string_view system = rinex_field(line_, 48, 3);
    if (!system.empty()) time_system_ = std::string(system);
  } else if (label == "APPROX POSITION XYZ") {
    const auto x = rinex_number(line_, 0, 14), y = rinex_number(line_, 14, 14),
               z = rinex_number(line_, 28, 14);
    constexpr double kNearSurface_m = 6.3e6;
    if (!x || !y || !z) return;
    const Eigen::Vector3d place(*x, *y, *z);
    if (place.norm() > kNearSurface_m && place.norm() < 1.1 * kNearSurface_m) stated_place_ = place;
  }
  if (part_ == Part::event) choose_columns();
}

/// "     4    C1    L1    S1    D1", nine to a line.
void RinexObservations::take_types_2() {
  std::vector<std::string>& types = types_[' '];
  if (const auto count = rinex_count(line_, 0, 6)) {
    types.clear();
    announced_[' '] = static_cast<std::size_t>(*count);
  }
  for (std::size_t i = 0; i < 9 && types.size() < std::min(announced_[' '], kMostTypes); ++i)
    types.emplace_back(rinex_field(line_, 6 + 6 * i, 6));
}

/// "G    4 C1C L1C D1C S1C", thirteen to a line.
void RinexObservations::take_types_3() {
  if (!line_.empty() && line_[0] != ' ') {
    types_of_ = line_[0];
    types_[types_of_].clear();
    announced_[types_of_] = static_cast<std::size_t>(rinex_count(line_, 3, 3).value_or(0));
  }
  std::vector<std::string>& types = types_[types_of_];
  for (std::size_t i = 0; i < 13 && types.size() < std::min(announced_[types_of_], kMostTypes); ++i)
    types.emplace_back(rinex_field(line_, 7 + 4 * i, 3));
}

void RinexObservations::choose_columns() {
  columns_.clear();
  for (const auto& [system, types] : types_) {
    const RinexColumns columns = version_.version < 3 ? columns_2(types) : columns_3(system, types);
    if (columns.pseudorange) columns_[system] = columns;
  }
  if (columns_.empty())
    fail(
        "the header announces no pseudorange of a first frequency (C1, P1; C1C, C1X, C2I, ...); carrier phases alone "
        "cannot be used");
}

std::size_t RinexObservations::lines_per_satellite() const {
  if (version_.version >= 3) return 1;
  const auto types = types_.find(' ');
  const std::size_t count = types == types_.end() ? 0 : types->second.size();
  return std::max<std::size_t>(1, (count + kPerLine2 - 1) / kPerLine2);
}

std::optional<Stamp> RinexObservations::on_gps(const RinexDate& date) const {
  std::optional<Stamp> stamp = stamp_of(date);
  if (!stamp) return stamp;
  constexpr std::int64_t kBeidouBehind = 14;
  if (time_system_ == "GLO")
    return convert(Stamp{stamp->nanoseconds + kGpsEpochPosix}, TimeScale::utc, TimeScale::gps);
  if (time_system_ == "BDT") stamp->nanoseconds += kBeidouBehind * kSecondNanoseconds;
  return stamp;
}

void RinexObservations::take_epoch_line() {
  const bool three = version_.version >= 3;
  if (line_.find_first_not_of(' ') == std::string_view::npos) return;
  if (three && line_[0] != '>') return complain(1, "expected an epoch, which begins with '>'");
  const auto flag = rinex_count(line_, three ? 31 : 28, 1);
  const auto count = rinex_count(line_, three ? 32 : 29, 3);
  if (!flag || !count || *flag > 6 || *count > kMostSatellites)
    return complain(three ? 32 : 29, "expected an epoch: its flag, 0 to 6, and the number of its satellites");
  const auto field = [&](std::size_t at2, std::size_t at3) {
    return rinex_count(line_, three ? at3 : at2, 2).value_or(-1);
  };
  const auto year = three ? rinex_count(line_, 2, 4) : rinex_count(line_, 1, 2);
  const auto second = rinex_number(line_, three ? 18 : 15, 11);
  std::optional<Stamp> stamp;
  if (year && second)
    stamp = on_gps({*year, field(4, 7), field(7, 10), field(10, 13), field(13, 16), *second});
  begin_epoch(*flag, *count, stamp);
}

void RinexObservations::begin_epoch(int flag, int count, const std::optional<Stamp>& stamp) {
  constexpr int kCycleSlips = 6;
  epoch_line_ = number_;
  expected_ = static_cast<std::size_t>(count);
  seen_ = 0;
  names_.clear();
  epoch_ = {};
  const bool measures = flag <= 1;
  if (!measures) ++events_;
  if (!measures && flag != kCycleSlips) {
    part_ = expected_ == 0 ? Part::between : Part::event;
    return;
  }
  counts_ = measures;
  is_dated_ = stamp.has_value();
  // Its satellites are read all the same, so that the next epoch is found.
  if (!is_dated_ && counts_) complain(version_.version >= 3 ? 3 : 2, "expected a date of the epoch");
  epoch_.moment = stamp.value_or(Stamp{});
  observations_.clear();
  lines_ = 0;
  if (expected_ == 0) {
    part_ = Part::between;
  } else if (version_.version < 3) {
    part_ = Part::names;
    take_names();
  } else {
    part_ = Part::satellites;
  }
}

/// Twelve satellites to a line, from column 33.
void RinexObservations::take_names() {
  for (std::size_t i = 0; i < kNamesPerLine2 && names_.size() < expected_; ++i)
    names_.emplace_back(line_.size() < 32 + 3 * i + 3 ? std::string_view() : line_.substr(32 + 3 * i, 3));
  if (names_.size() == expected_) part_ = Part::satellites;
}

bool RinexObservations::begins_epoch() const {
  if (version_.version >= 3) return line_.starts_with('>');
  // The point of the seconds; observations have theirs at 10, 26, 42, ...
  constexpr std::size_t kPoint = 18;
  if (line_.size() < kPoint + 1 || line_[kPoint] != '.') return false;
  const auto flag = rinex_count(line_, 28, 1);
  const auto month = rinex_count(line_, 4, 2);
  return flag && *flag <= 6 && month && *month <= 12 && rinex_count(line_, 29, 3);
}

void RinexObservations::take_satellite_line() {
  if (begins_epoch()) {
    lose_epoch(fmt::format("the next epoch begins after {} of {} satellites of the epoch of line {}", seen_,
                           expected_, epoch_line_));
    part_ = Part::between;
    return take_epoch_line();
  }
  if (version_.version >= 3) {
    take_measurement(line_);
    return end_satellite();
  }
  std::string columns(line_.substr(0, kLine2));
  columns.resize(kLine2, ' ');
  observations_ += columns;
  if (++lines_ < lines_per_satellite()) return;
  take_measurement(names_[seen_] + observations_);
  observations_.clear();
  lines_ = 0;
  end_satellite();
}

/// @param line name of the satellite, then its observations
void RinexObservations::take_measurement(std::string_view line) {
  if (!counts_ || !is_dated_) return;
  const auto satellite = rinex_satellite(line.substr(0, 3), version_.system);
  if (!satellite) {
    ++unused_;
    return;
  }
  const auto columns = columns_.find(version_.version < 3 ? ' ' : letter_of(*satellite));
  if (columns == columns_.end()) {
    ++unused_;
    return;
  }
  const auto number = [&](const std::optional<std::size_t>& at) {
    return at ? rinex_number(line, 3 + kWidth * *at, 14) : std::nullopt;
  };
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const double doppler = number(columns->second.doppler).value_or(kNone);
  // RINEX has 0 for an observation that is missing.
  const auto measurement = satellites::raw_measurement(
      *satellite, number(columns->second.pseudorange).value_or(kNone), doppler == 0 ? kNone : doppler,
      number(columns->second.cn0).value_or(kNone));
  if (measurement)
    epoch_.satellites.push_back(*measurement);
  else
    ++unused_;
}

void RinexObservations::end_satellite() {
  if (++seen_ < expected_) return;
  part_ = Part::between;
  if (counts_ && is_dated_) listener_.epoch(epoch_);
}

void RinexObservations::lose_epoch(const std::string& what) {
  if (counts_) complain(1, what + "; the epoch is left out");
}

}  // namespace waymark::formats
