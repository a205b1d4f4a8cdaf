#include <waymark/formats/logs/detail/tables/table_inside.hpp>

#include <algorithm>
#include <span>
#include <utility>

#include <waymark/formats/logs/detail/common/inner_log.hpp>
#include <waymark/formats/logs/detail/csv/csv_log.hpp>
#include <waymark/formats/logs/detail/csv/csv_table.hpp>

namespace waymark::formats {

void TableInside::open_table(std::string_view header, std::size_t number, std::span<const KnownColumn> known,
                             char separator, TimeScale own, LogRequest inner) {
  static const CsvLogReader csv;
  std::vector<std::string_view> names;
  (void)split_fields(header, separator, names);
  for (const KnownColumn& column : known) {
    const std::string quantity(column.quantity);
    if (inner.columns.contains(quantity)) continue;
    const auto name =
        std::find_first_of(names.begin(), names.end(), column.names.begin(), column.names.end());
    if (name == names.end()) continue;
    inner.columns[quantity] = {std::string(*name), std::string(column.unit), std::string(column.convention)};
  }
  own_ = own;
  inner.separator = separator;
  inner.time_scale = own;
  table_ = csv.open(path(), inner);
  give_row(header, number);
}

void TableInside::give_row(std::string_view row, std::size_t number) {
  while (given_ + 1 < number) give("#");  // the table's lines have the numbers of the log's
  give(row);
  move_samples();
}

void TableInside::give(std::string_view line) {
  table_->take(line);
  table_->take("\n");
  ++given_;
}

void TableInside::move_samples() {
  LogData& inner = table_->data();
  for (GeodeticFix& fix : inner.fixes) {
    fix.stamp = convert(fix.stamp, own_, request().time_scale);
    data_.fixes.push_back(fix);
  }
  for (GeodeticTruth& truth : inner.truth) {
    truth.stamp = convert(truth.stamp, own_, request().time_scale);
    data_.truth.push_back(truth);
  }
  inner.fixes.clear();
  inner.truth.clear();
}

void TableInside::finish_table() {
  table_->finish();
  move_samples();
  LogData& inner = table_->data();
  add_counts(data_, inner);
  for (const auto& [quality, count] : inner.qualities) data_.qualities[quality] += count;
}

}  // namespace waymark::formats
