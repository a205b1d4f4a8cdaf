#include <waymark/tools/inspection/survey/table_survey.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include <waymark/formats/logs/detail/csv/csv_columns.hpp>
#include <waymark/formats/logs/detail/csv/csv_table.hpp>
#include <waymark/formats/text/iso8601.hpp>

namespace waymark::inspection {
namespace {

/// Larger angles and times have another unit than the default.
void check_range(ColumnSummary& column) {
  ColumnProposal& proposal = column.proposal;
  const double largest =
      column.range.count == 0 ? 0 : std::max(std::abs(column.range.smallest), std::abs(column.range.largest));
  if (proposal.quantity == "time") {
    // Seconds since 1970 have ten digits now.
    if (largest > 1e17)
      proposal.unit = "ns";
    else if (largest > 1e14)
      proposal.unit = "us";
    else if (largest > 1e11)
      proposal.unit = "ms";
    return;
  }
  if (proposal.unit_known) return;
  const bool position = proposal.quantity == "latitude" || proposal.quantity == "longitude";
  if (position && largest > 360) {
    proposal.unit = "1e-7deg";
    proposal.remark = "the numbers look like degrees times 10^7";
    return;
  }
  if (position && largest <= 3.2 && column.range.count > 0 && column.range.largest != column.range.smallest)
    proposal.remark = "degrees are assumed; the numbers could be radians";
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
  if (proposal.quantity == "heading" && largest > 13) {
    proposal.unit = "deg";
    proposal.remark = "no unit is named; the numbers look like degrees";
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
  static constexpr std::array<std::string_view, 3> kWithout{"valid", "wheel_ticks", "reverse"};
  return proposal.unit_known ||
         std::find(kWithout.begin(), kWithout.end(), proposal.quantity) != kWithout.end();
}

}  // namespace

void keep_one_each(std::vector<ColumnSummary>& columns) {
  const auto better = [](const ColumnProposal& a, const ColumnProposal& b) {
    if (a.remark.empty() != b.remark.empty()) return a.remark.empty();
    return names_unit(a) && !names_unit(b);
  };
  std::map<std::string, ColumnSummary*> owner;
  for (ColumnSummary& column : columns) {
    if (column.proposal.quantity.empty()) continue;
    ColumnSummary*& first = owner[column.proposal.quantity];
    if (first == nullptr) {
      first = &column;
    } else if (better(column.proposal, first->proposal)) {
      give_way(*first, column);
      first = &column;
    } else {
      give_way(column, *first);
    }
  }
}

void TableSurvey::take_line(std::string_view line, std::size_t number) {
  const std::string_view content = formats::table_content(line, number);
  if (content.empty()) return;
  if (content.front() == '#') {
    if (!begun_) comment_ = content.substr(1);
    return;
  }
  if (number == 1) line = content;
  if (!begun_) return begin(line);
  ++data_.records;
  ++summary_.rows;
  if (!formats::split_fields(line, summary_.separator, fields_) || fields_.size() != width_)
    return corrupt(number, 1, fmt::format("{} fields, but the header has {}", fields_.size(), width_));
  for (std::size_t i = 0; i < columns_.size(); ++i) take_field(columns_[i], fields_[i]);
}

void TableSurvey::begin(std::string_view line) {
  begun_ = true;
  summary_.separator = formats::separator_of(line);
  if (!formats::split_fields(line, summary_.separator, fields_)) return;
  width_ = fields_.size();
  columns_.resize(std::min(width_, kMostColumns));
  const bool numbers = std::all_of(fields_.begin(), fields_.end(), [this](std::string_view field) {
    return formats::number_from_field(field, summary_.separator).has_value() ||
           formats::stamp_from_iso8601(field).has_value();
  });
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
  for (std::size_t i = 0; i < columns_.size(); ++i)
    columns_[i].seen.name = names[i].empty() ? std::to_string(i + 1) : std::string(names[i]);
  std::size_t times = 0;
  for (Column& column : columns_)
    column.is_time = propose_quantity(column.seen.name).quantity == "time" && ++times <= 4;
  if (!numbers) return;
  ++summary_.rows;
  for (std::size_t i = 0; i < columns_.size(); ++i) take_field(columns_[i], fields_[i]);
}

void TableSurvey::take_field(Column& column, std::string_view field) {
  double value = 0;
  if (const std::optional<double> number = formats::number_from_field(field, summary_.separator)) {
    if (std::isnan(*number)) {
      ++column.seen.empty;
      return;
    }
    value = *number;
    column.dates = false;
    column.seen.range.add(value);
  } else {
    ++column.seen.words;
    if (!column.dates) return;
    const std::optional<Stamp> date = formats::stamp_from_iso8601(field);
    column.dates = date.has_value();
    if (!date) return;
    value = date->seconds();
  }
  if (column.seen.values + (column.dates ? column.seen.words : 0) > 0) {
    if (column.is_time && value > column.last) column.steps.add(value - column.last);
  }
  column.last = value;
  ++column.seen.values;
}

TableSummary TableSurvey::summary() const {
  TableSummary result = summary_;
  for (const Column& column : columns_) {
    ColumnSummary seen = column.seen;
    if (summary_.has_header) seen.proposal = propose_quantity(seen.name);
    const bool dates = column.dates && seen.words > 0;
    if (dates) {
      seen.values = seen.words;
      if (seen.proposal.quantity.empty()) seen.proposal = {"time", "", "", false, "the column holds dates"};
      if (seen.proposal.quantity == "time") seen.proposal.unit = "iso8601";
    } else if (seen.range.count == 0) {
      seen.proposal = {};  // words or nothing: there is no quantity
    }
    check_range(seen);
    if (seen.proposal.quantity == "time" && column.steps.count() > 0) {
      const std::string& unit = seen.proposal.unit;
      const double step = column.steps.median() * (unit == "ms"   ? 1e-3
                                                   : unit == "us" ? 1e-6
                                                   : unit == "ns" ? 1e-9
                                                                  : 1);
      seen.rate_hz = 1 / step;
    }
    result.columns.push_back(std::move(seen));
  }
  keep_one_each(result.columns);
  return result;
}

}  // namespace waymark::inspection
