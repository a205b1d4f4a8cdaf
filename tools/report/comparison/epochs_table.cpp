#include <algorithm>
#include <charconv>
#include <optional>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/csv/csv_table.hpp>
#include <waymark/tools/report/comparison/epochs_table.hpp>

namespace waymark::report {
namespace {

/// Reads the lines below the heading, one at a time.
class Table {
 public:
  Table(std::string_view text, const std::string& name) : rest_(text), name_(name) {
    split();
    heading_ = fields_;
  }
  [[nodiscard]] bool next() {
    if (rest_.empty()) return false;
    split();
    if (fields_.size() == heading_.size()) return true;
    throw InputError(fmt::format("{}:{}: expected {} fields, as in the heading, got {}", name_, line_,
                                 heading_.size(), fields_.size()));
  }
  /// Folders of earlier versions lack some columns.
  [[nodiscard]] std::optional<std::size_t> column_if_there(const std::string& name) const {
    const auto found = std::find(heading_.begin(), heading_.end(), name);
    return found == heading_.end() ? std::nullopt
                                   : std::optional(static_cast<std::size_t>(found - heading_.begin()));
  }
  [[nodiscard]] std::size_t column(const std::string& name) const {
    const auto found = std::find(heading_.begin(), heading_.end(), name);
    if (found == heading_.end()) throw InputError(fmt::format("{}:1: has no column '{}'", name_, name));
    return static_cast<std::size_t>(found - heading_.begin());
  }
  template <typename Number>
  [[nodiscard]] std::optional<Number> number(std::size_t column) const {
    const std::string_view field = fields_[column];
    if (field.empty()) return std::nullopt;
    Number value{};
    const char* last = field.data() + field.size();
    const auto [end, error] = std::from_chars(field.data(), last, value);
    if (error == std::errc() && end == last) return value;
    throw InputError(
        fmt::format("{}:{}: expected a number for '{}', got '{}'", name_, line_, heading_[column], field));
  }

 private:
  void split() {
    ++line_;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    if (!formats::split_fields(rest_.substr(0, end), ',', fields_))
      throw InputError(fmt::format("{}:{}: a quote is not closed", name_, line_));
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
  }

  std::string_view rest_;
  std::string name_;
  int line_ = 0;
  std::vector<std::string_view> heading_;
  std::vector<std::string_view> fields_;
};

}  // namespace

std::vector<evaluation::EpochResult> read_epochs_table(std::string_view text, const std::string& name) {
  Table table(text, name);
  const std::size_t stamp = table.column("stamp_ns");
  const std::size_t nees = table.column("nees");
  const auto offset_columns = [&](const std::string& system) {
    return std::pair{table.column(system + "_east_m"), table.column(system + "_north_m")};
  };
  const auto gnss = offset_columns("gnss");
  const auto fused = offset_columns("fused");
  const auto latitude = table.column_if_there("fused_latitude_deg");
  const auto longitude = table.column_if_there("fused_longitude_deg");
  const auto offset = [&](const std::pair<std::size_t, std::size_t>& columns) {
    const auto east = table.number<double>(columns.first);
    const auto north = table.number<double>(columns.second);
    return east && north ? std::optional(Eigen::Vector2d(*east, *north)) : std::nullopt;
  };
  std::vector<evaluation::EpochResult> epochs;
  while (table.next()) {
    evaluation::EpochResult epoch;
    epoch.stamp.nanoseconds = table.number<std::int64_t>(stamp).value_or(0);
    epoch.gnss_offset_m = offset(gnss);
    epoch.fused_offset_m = offset(fused);
    epoch.nees = table.number<double>(nees).value_or(evaluation::kUndefined);
    const auto north = latitude ? table.number<double>(*latitude) : std::nullopt;
    const auto east = longitude ? table.number<double>(*longitude) : std::nullopt;
    if (north && east) epoch.fused_place = GeodeticPoint{*north, *east};
    epochs.push_back(std::move(epoch));
  }
  return epochs;
}

}  // namespace waymark::report
