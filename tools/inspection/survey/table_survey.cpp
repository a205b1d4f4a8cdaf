#include <waymark/tools/inspection/survey/table_survey.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include <waymark/formats/logs/detail/csv/csv_columns.hpp>
#include <waymark/formats/logs/detail/csv/csv_table.hpp>
#include <waymark/formats/logs/detail/csv/table_header.hpp>
#include <waymark/formats/text/detail/characters.hpp>

namespace waymark::inspection {
namespace {

/// Tells the unit of times by their size. Seconds since 1970 have ten digits now.
/// @param step the median of the steps between times
void check_times(ColumnSummary& column, double largest, double step) {
  ColumnProposal& proposal = column.proposal;
  const auto days_of = [&](const char* unit, const char* program) {
    proposal.unit = unit;
    proposal.remark = fmt::format("the numbers look like the days of {}", program);
  };
  constexpr double kLongestStep = 0.01;  // of a day
  const bool days = step > 0 && step < kLongestStep && column.range.smallest > 0;
  if (largest > 1e17 && largest < 1.8e17)
    proposal.unit = "filetime";
  else if (largest > 1e17)
    proposal.unit = "ns";
  else if (largest > 1e14)
    proposal.unit = "us";
  else if (largest > 1e11)
    proposal.unit = "ms";
  else if (days && column.range.smallest > 7.2e5 && largest < 8e5)
    days_of("matlab", "MATLAB");
  else if (days && column.range.smallest > 3.2e4 && largest < 6e4 && step < 1e-3)
    days_of("excel", "a spreadsheet");
}

/// Tells how a date of numbers is written.
void check_dates(ColumnSummary& column, double largest) {
  ColumnProposal& proposal = column.proposal;
  if (proposal.unit == "gps_week") return;
  if (largest >= 19'800'101 && largest < 21'000'000) {
    proposal.unit_known = true;  // 20240131
  } else if (largest > 10'100 && largest < 320'000) {
    proposal.unit = "dmy";
    proposal.remark = "six digits are taken as day, month, year, as in NMEA";
  } else if (largest > 500 && largest < 10'000) {
    proposal.unit = "gps_week";
    proposal.remark = "the numbers look like GPS weeks";
  } else {
    proposal = {};
  }
}

/// Larger angles and times have another unit than the default.
void check_range(ColumnSummary& column, double step) {
  ColumnProposal& proposal = column.proposal;
  const double largest =
      column.range.count == 0 ? 0 : std::max(std::abs(column.range.smallest), std::abs(column.range.largest));
  if (column.range.count == 0 && proposal.unit_known) return;  // words
  if (proposal.quantity == "time") return check_times(column, largest, step);
  if (proposal.quantity == "date") return check_dates(column, largest);
  const bool position = proposal.quantity == "latitude" || proposal.quantity == "longitude";
  if (position && largest > 90 && largest < 18'060 && (largest > 360 || proposal.quantity == "latitude")) {
    proposal.unit = "ddmm";
    proposal.remark = "the numbers look like degrees and minutes, ddmm.mmmm";
    return;
  }
  if (proposal.unit_known) return;
  if (position && largest > 360) {
    proposal.unit = "1e-7deg";
    proposal.remark = "the numbers look like degrees times 10^7";
    return;
  }
  if (proposal.quantity == "speed" && largest > 75) {
    proposal.unit = "km/h";
    proposal.remark =
        fmt::format("no unit is named; values up to {:.4g} are too large for a road vehicle in m/s", largest);
  }
  if ((proposal.quantity == "yaw_rate" || proposal.quantity.starts_with("gyro")) && largest > 4) {
    proposal.unit = "deg/s";
    proposal.remark =
        fmt::format("no unit is named; values up to {:.4g} are too large for a vehicle in rad/s", largest);
  }
  if ((proposal.quantity == "heading" || proposal.quantity == "course") && column.range.smallest < -1.5 &&
      column.range.largest - column.range.smallest > 4.5 && largest < 3.15) {
    proposal.unit = "rad";
    proposal.remark = "no unit is named; the numbers look like radians";
  }
  if (proposal.quantity == "heading" && largest > 13) {
    proposal.unit = "deg";
    proposal.remark = "no unit is named; the numbers look like degrees";
  }
}

/// The size of a unit of times in seconds.
double seconds_of(const std::string& unit) {
  if (unit == "ms") return 1e-3;
  if (unit == "us") return 1e-6;
  if (unit == "ns") return 1e-9;
  if (unit == "filetime") return 1e-7;
  return unit == "excel" || unit == "matlab" ? 86400 : 1;
}

/// Beside a date, numbers such as 120000.25 are times of day as NMEA writes them. A date that stands beside
/// complete instants has no use.
void settle_times_of_day(std::vector<ColumnSummary>& columns) {
  const auto proposed = [&](std::string_view quantity) {
    return std::find_if(columns.begin(), columns.end(),
                        [&](const ColumnSummary& column) { return column.proposal.quantity == quantity; });
  };
  const auto date = proposed("date");
  const auto time = proposed("time");
  if (date == columns.end()) return;
  if (time == columns.end()) {
    date->proposal = {};
    return;
  }
  if (time->range.count == 0) {
    if (time->proposal.unit != "hms") date->proposal = {};
    return;
  }
  if (date->proposal.unit == "gps_week") {
    if (time->range.largest > 604'800 && time->proposal.unit.empty()) date->proposal = {};
    return;
  }
  if (time->range.largest >= 240'000 || time->range.smallest < 0) {
    date->proposal = {};
  } else if (time->range.largest > 86'400) {
    time->proposal.unit = "hms";
    time->proposal.remark = "the numbers look like hhmmss";
  } else {
    time->proposal.remark = "seconds of the day are assumed; for hhmmss the unit is hms";
  }
}

/// A place of less than 1.6 degrees north and 3.2 degrees east is in the sea: the numbers are radians.
void settle_radians(std::vector<ColumnSummary>& columns) {
  const auto proposed = [&](std::string_view quantity, double quarters) {
    return std::find_if(columns.begin(), columns.end(), [&](const ColumnSummary& column) {
      const double most = quarters * std::numbers::pi / 2;
      return column.proposal.quantity == quantity && !column.proposal.unit_known && column.range.count > 0 &&
             column.range.smallest >= -most && column.range.largest <= most &&
             column.range.smallest != column.range.largest;
    });
  };
  const auto latitude = proposed("latitude", 1);
  const auto longitude = proposed("longitude", 2);
  if (latitude == columns.end() || longitude == columns.end()) return;
  // Simulators have their origin at 0, 0.
  constexpr double kSomewhere = 0.1;
  if (std::max(std::abs(latitude->range.largest), std::abs(longitude->range.largest)) < kSomewhere) return;
  for (const auto& column : {latitude, longitude}) {
    column->proposal.unit = "rad";
    column->proposal.remark = "no unit is named; the numbers look like radians";
  }
}

/// Whether the numbers are those of a coordinate in degrees of a drive: not whole, and within a degree.
bool may_be_degrees(const ColumnSummary& column, double largest) {
  const Range& range = column.range;
  return range.count > 0 && column.words == 0 && range.smallest > -largest && range.largest < largest &&
         range.largest - range.smallest < 1 &&
         std::min(std::abs(range.smallest), std::abs(range.largest)) > 1 &&
         std::floor(range.smallest) != range.smallest && std::floor(range.largest) != range.largest;
}

/// A table without names: the numbers tell the times and the position, if they are where they usually are.
void propose_by_numbers(std::vector<ColumnSummary>& columns, bool first_rises) {
  if (columns.empty() || !first_rises) return;
  const auto propose = [](ColumnSummary& column, const char* quantity) {
    column.proposal = {quantity, column.proposal.unit, "", false,
                       fmt::format("the table has no names; its numbers look like a {}", quantity)};
  };
  propose(columns.front(), "time");
  check_times(columns.front(), columns.front().range.largest, 0);
  for (std::size_t i = 1; i + 1 < columns.size(); ++i) {
    if (!may_be_degrees(columns[i], 90) || !may_be_degrees(columns[i + 1], 180)) continue;
    propose(columns[i], "latitude");
    propose(columns[i + 1], "longitude");
    return;
  }
}

/// Metres in a plane are named, because only the user knows their origin.
void remark_on_metres(std::vector<ColumnSummary>& columns) {
  const auto named = [&](std::initializer_list<std::string_view> names) {
    return std::find_if(columns.begin(), columns.end(), [&](const ColumnSummary& column) {
      const std::string name = formats::plain_name(column.name);
      return column.range.count > 0 && std::find(names.begin(), names.end(), name) != names.end();
    });
  };
  const auto east = named({"x", "x_m", "east", "east_m", "e", "easting", "easting_m", "enu_e", "pos_x"});
  const auto north = named({"y", "y_m", "north", "north_m", "n", "northing", "northing_m", "enu_n", "pos_y"});
  if (east == columns.end() || north == columns.end() || !east->proposal.quantity.empty()) return;
  east->proposal.remark = fmt::format(
      "may be metres: state 'easting: {}', 'northing: {}' under columns, and a frame: 'frame: {{utm_zone: "
      "32N}}' or 'frame: {{enu_origin: [latitude, longitude]}}'",
      east->name, north->name);
}

/// Finds seconds whose fractions are in a column of their own: "header.stamp.secs", "header.stamp.nsecs".
/// @param found takes both, for each of them
template <typename Found>
void find_fractions(std::vector<ColumnSummary>& columns, Found found) {
  const auto words_before_last = [](const ColumnSummary& column,
                                    std::initializer_list<std::string_view> lasts) {
    std::vector<std::string> words = words_of(column.name);
    if (words.empty() || std::find(lasts.begin(), lasts.end(), words.back()) == lasts.end()) words.clear();
    if (!words.empty()) words.pop_back();
    return words;
  };
  for (ColumnSummary& seconds : columns) {
    const std::vector<std::string> name = words_before_last(seconds, {"sec", "secs"});
    if (name.empty() || seconds.proposal.quantity != "time") continue;
    for (ColumnSummary& fractions : columns)
      if (words_before_last(fractions, {"nsec", "nsecs", "nanosec"}) == name) found(seconds, fractions);
  }
}

/// Removes a proposal if another column has the same one.
void give_way(ColumnSummary& column, const ColumnSummary& to) {
  const std::string remark =
      fmt::format("also a candidate for {}; '{}' is used", to.proposal.quantity, to.name);
  column.proposal = {};
  column.proposal.remark = remark;
}

bool names_unit(const ColumnProposal& proposal) {
  static constexpr std::array<std::string_view, 6> kWithout{"valid",   "wheel_ticks", "reverse",
                                                            "quality", "hdop",        "satellites"};
  return proposal.unit_known ||
         std::find(kWithout.begin(), kWithout.end(), proposal.quantity) != kWithout.end();
}

}  // namespace

bool is_of_receiver(const std::string& signal) {
  const std::vector<std::string> words = words_of(signal);
  return std::any_of(words.begin(), words.end(),
                     [](const std::string& word) { return word == "gnss" || word == "gps"; });
}

void keep_one_each(std::vector<ColumnSummary>& columns, bool of_bus) {
  find_fractions(columns, [](ColumnSummary& seconds, ColumnSummary& fractions) {
    seconds.proposal.remark = fmt::format("whole seconds, with their fractions in '{}'", fractions.name);
    fractions.proposal = {};
  });
  const auto better = [](const ColumnProposal& a, const ColumnProposal& b) {
    if (a.remark.empty() != b.remark.empty()) return a.remark.empty();
    return names_unit(a) && !names_unit(b);
  };
  std::map<std::pair<std::string, bool>, ColumnSummary*> owner;
  for (ColumnSummary& column : columns) {
    if (column.proposal.quantity.empty()) continue;
    const bool receiver = of_bus && column.proposal.quantity == "speed" && is_of_receiver(column.name);
    ColumnSummary*& first = owner[{column.proposal.quantity, receiver}];
    if (first == nullptr) {
      first = &column;
    } else if (better(column.proposal, first->proposal)) {
      give_way(*first, column);
      first = &column;
    } else {
      give_way(column, *first);
    }
  }
  find_fractions(columns, [](ColumnSummary&, ColumnSummary& fractions) {
    fractions.proposal = {"time_fraction", "ns", "", true, ""};
  });
}

void TableSurvey::take_line(std::string_view line, std::size_t number) {
  const std::string_view content = formats::without_blanks(line);
  if (content.empty()) return;
  if (content.front() == '#') {
    if (!begun_) comment_ = content.substr(1);
    return;
  }
  if (begun_) return take_row(line, number);
  if (const auto stated = waiting_.empty() ? formats::stated_separator(line) : std::nullopt) {
    stated_separator_ = *stated;
    return;
  }
  waiting_.emplace_back(line);
  numbers_.push_back(number);
  comments_.push_back(comment_);
  const std::optional<formats::TableStart> start = formats::table_start(waiting_, stated_separator_);
  if (start || waiting_.size() >= formats::kMostLinesAbove)
    begin_waiting(start.value_or(formats::TableStart{}));
}

void TableSurvey::end() {
  if (!begun_ && !waiting_.empty()) begin_waiting({});
}

void TableSurvey::begin_waiting(const formats::TableStart& start) {
  comment_ = comments_[start.header];
  begin(waiting_[start.header]);
  std::size_t row = start.header + 1;
  // Of the lines between a header and its values, one may hold units.
  for (; row < start.first_row && row < waiting_.size(); ++row)
    if (formats::split_fields(waiting_[row], summary_.separator, fields_) && fields_.size() == width_ &&
        formats::is_unit_row(fields_, summary_.separator) && std::exchange(may_have_units_, false))
      for (std::size_t i = 0; i < columns_.size(); ++i)
        columns_[i].seen.unit = formats::unit_in_row(fields_[i]);
  for (; row < waiting_.size(); ++row) take_row(waiting_[row], numbers_[row]);
  waiting_.clear();
}

void TableSurvey::take_row(std::string_view line, std::size_t number) {
  const bool whole = formats::split_fields(line, summary_.separator, fields_) && fields_.size() == width_;
  if (std::exchange(may_have_units_, false) && whole && formats::is_unit_row(fields_, summary_.separator)) {
    for (std::size_t i = 0; i < columns_.size(); ++i)
      columns_[i].seen.unit = formats::unit_in_row(fields_[i]);
    return;
  }
  ++data_.records;
  ++summary_.rows;
  if (!whole)
    return corrupt(number, 1, fmt::format("{} fields, but the header has {}", fields_.size(), width_));
  for (std::size_t i = 0; i < columns_.size(); ++i) take_field(columns_[i], fields_[i]);
}

/// Tells whether a line holds values: the first field does, and more than half of those that are not empty. A few words
/// may stand beside them: a status, a frame.
bool TableSurvey::holds_values() const {
  const auto is_value = [this](std::string_view field) {
    const std::optional<double> number = formats::number_from_field(field, summary_.separator);
    return (number && !std::isnan(*number)) || holds_instants(forms_of(field, kAllForms));
  };
  const auto filled = std::count_if(fields_.begin(), fields_.end(), [this](std::string_view field) {
    const std::optional<double> number = formats::number_from_field(field, summary_.separator);
    return !number || !std::isnan(*number);
  });
  return is_value(fields_.front()) && 2 * std::count_if(fields_.begin(), fields_.end(), is_value) > filled;
}

void TableSurvey::begin(std::string_view line) {
  begun_ = true;
  summary_.separator = stated_separator_ != 0 ? stated_separator_ : formats::separator_of(line);
  if (!formats::split_fields(line, summary_.separator, fields_)) return;
  width_ = fields_.size();
  columns_.resize(std::min(width_, kMostColumns));
  const bool numbers = holds_values();
  std::vector<std::string_view> names = fields_;
  if (numbers) {
    std::vector<std::string_view> above;
    const bool named =
        formats::split_fields(comment_, summary_.separator, above) && above.size() == fields_.size();
    summary_.has_header = named;
    names = named ? above : std::vector<std::string_view>(fields_.size());
  } else {
    summary_.first_line = comment_;
  }
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    columns_[i].seen.name = names[i].empty() ? std::to_string(i + 1) : std::string(names[i]);
    if (std::count(names.begin(), names.end(), names[i]) > 1) columns_[i].seen.number = std::to_string(i + 1);
  }
  std::size_t times = 0;
  if (!summary_.has_header) columns_.front().is_time = true;
  for (Column& column : columns_) {
    column.is_time =
        column.is_time || (propose_quantity(column.seen.name).quantity == "time" && ++times <= 4);
    column.tells_receivers = names_receiver(column.seen.name);
  }
  may_have_units_ = !numbers;
  if (!numbers) return;
  ++summary_.rows;
  for (std::size_t i = 0; i < columns_.size(); ++i) take_field(columns_[i], fields_[i]);
}

void TableSurvey::take_field(Column& column, std::string_view field) {
  constexpr std::size_t kMostReceivers = 5;
  std::vector<std::string>& names = column.seen.receivers;
  if (column.tells_receivers && !field.empty() && names.size() < kMostReceivers &&
      std::find(names.begin(), names.end(), field) == names.end())
    names.emplace_back(field);
  double value = 0;
  if (const std::optional<double> number = formats::number_from_field(field, summary_.separator)) {
    if (std::isnan(*number)) {
      ++column.seen.empty;
      return;
    }
    value = *number;
    column.seen.range.add(value);
    const auto mark = std::find(kMarks.begin(), kMarks.end(), value);
    if (mark != kMarks.end()) {
      ++column.marks[static_cast<std::size_t>(mark - kMarks.begin())];
    } else {
      column.others.add(value);
      column.others_have_fractions = column.others_have_fractions || value != std::floor(value);
    }
  } else {
    ++column.seen.words;
    column.forms = forms_of(field, column.forms);
    if (!holds_instants(column.forms)) return;
    value = instant_seconds(field, column.forms);
  }
  if (column.seen.values > 0 && column.is_time && value > column.last) column.steps.add(value - column.last);
  column.last = value;
  ++column.seen.values;
}

/// A number that means "not known" comes several times and lies far from all others: it is taken out of the range.
/// -1 is one where no other number is negative and others have fractions, as the reader takes it.
void TableSurvey::find_mark(const Column& column, ColumnSummary& seen) {
  constexpr std::size_t kFewest = 3;
  constexpr double kFar = 2;
  static constexpr std::array<std::string_view, 9> kWithout{"time",    "date",        "gnss_time",
                                                            "valid",   "quality",     "satellites",
                                                            "reverse", "wheel_ticks", "time_fraction"};
  const std::string& quantity = seen.proposal.quantity;
  if (quantity.empty() || column.others.count == 0 || quantity.starts_with("wheel_ticks") ||
      std::find(kWithout.begin(), kWithout.end(), quantity) != kWithout.end())
    return;
  const double largest = std::max(std::abs(column.others.smallest), std::abs(column.others.largest));
  std::optional<double> found;
  for (std::size_t i = 0; i < kMarks.size(); ++i) {
    if (column.marks[i] == 0) continue;
    const bool is_mark = kMarks[i] == -1 ? column.others.smallest >= 0 && column.others_have_fractions
                                         : std::abs(kMarks[i]) > kFar * largest;
    if (found || !is_mark || column.marks[i] < kFewest) return;
    found = kMarks[i];
  }
  if (!found) return;
  seen.proposal.missing = found;
  seen.range = column.others;
  seen.proposal.remark +=
      fmt::format("{}{:g} is taken for 'not known'", seen.proposal.remark.empty() ? "" : "; ", *found);
}

/// Returns a column with its proposal.
ColumnSummary TableSurvey::summary_of(const Column& column) const {
  ColumnSummary seen = column.seen;
  if (seen.receivers.size() < 2 || seen.receivers.size() > 4) seen.receivers.clear();
  if (summary_.has_header)
    seen.proposal =
        propose_quantity(seen.unit.empty() ? seen.name : fmt::format("{} [{}]", seen.name, seen.unit));
  const double step = column.steps.count() > 0 ? column.steps.median() : 0;
  const bool words = seen.words > 0 && seen.range.count == 0;
  if (words) seen.values = seen.words;
  if (words) {
    seen.proposal = proposal_of_forms(column.forms, seen.proposal);
  } else if (seen.range.count == 0) {
    seen.proposal = {};  // nothing: there is no quantity
  }
  find_mark(column, seen);
  check_range(seen, step);
  if (seen.proposal.quantity == "time" && step > 0)
    seen.rate_hz = 1 / (step * seconds_of(seen.proposal.unit));
  return seen;
}

TableSummary TableSurvey::summary() const {
  TableSummary result = summary_;
  for (const Column& column : columns_) result.columns.push_back(summary_of(column));
  if (!summary_.has_header && !columns_.empty())
    propose_by_numbers(result.columns, columns_.front().steps.count() + 1 == columns_.front().seen.values);
  else
    remark_on_metres(result.columns);
  settle_times_of_day(result.columns);
  settle_radians(result.columns);
  keep_one_each(result.columns);
  return result;
}

}  // namespace waymark::inspection
