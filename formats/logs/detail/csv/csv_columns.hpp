/// Maps the fields of a table to quantities.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/core/drive/log_reader.hpp>
#include <waymark/formats/logs/detail/common/quantity.hpp>
#include <waymark/formats/logs/detail/csv/csv_table.hpp>

namespace waymark::formats {

/// A quantity and its field.
struct BoundColumn {
  const Quantity* quantity = nullptr;
  std::size_t field = 0;
  double factor = 1;  ///< value = factor * number + offset; it includes the sense and the scale
  UnitForm form = UnitForm::number;
  double offset = 0;
  std::string_view unit;
  int time_power = 0;             ///< power of ten, for times
  std::optional<double> missing;  ///< a number that means "no value"
};

/// The columns of one stream in one table.
class CsvColumns {
 public:
  /// Finds the header and binds the quantities. The unit of a column is the stated one, else that of the row
  /// of units or of the brackets in its name, else the default.
  /// @param first first line of the table
  /// @param request with the separator
  /// @throws InputError see CsvLogReader
  CsvColumns(const TableLine& first, const std::string& path, const LogRequest& request);
  CsvColumns(const CsvColumns&) = delete;  // columns point to the quantities
  CsvColumns& operator=(const CsvColumns&) = delete;

  [[nodiscard]] bool first_line_is_header() const { return first_line_is_header_; }
  [[nodiscard]] std::size_t field_count() const { return field_count_; }
  /// Returns null if the table has no such quantity.
  [[nodiscard]] const BoundColumn* find(std::string_view quantity) const;
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }
  /// Returns the field that LogRequest::where compares; empty: all rows count.
  [[nodiscard]] std::optional<std::size_t> filtered() const { return filtered_; }

 private:
  void check_request(const std::string& place, const LogRequest& request) const;
  void find_header(const TableLine& first, const std::string& path, const LogRequest& request);
  void take_names(const std::vector<std::string_view>& names);
  void take_units(const std::vector<std::string_view>& row);
  void choose_position(const LogRequest& request, const std::string& place);
  void keep_ecef();
  void require_no_component(std::size_t field, const std::string& place) const;
  void bind(const Quantity& quantity, const ColumnRequest* wanted, const std::string& place);
  void require_one(std::string_view name, std::string_view use, const std::string& place) const;
  [[nodiscard]] std::optional<std::size_t> field_stated(const std::string& column, std::string_view use,
                                                        const std::string& place) const;
  [[nodiscard]] bool has_default_columns(std::string_view first, std::string_view second) const;
  [[nodiscard]] std::optional<std::size_t> field_named(std::string_view name) const;
  [[nodiscard]] std::optional<std::size_t> field_by_default(const Quantity& quantity,
                                                            const std::string& place) const;
  [[nodiscard]] const Unit& unit_of(const Quantity& quantity, const ColumnRequest& how, std::size_t field,
                                    const std::string& place);
  [[nodiscard]] std::string columns_present() const;
  [[nodiscard]] std::vector<std::string> shown_names() const;

  std::vector<Quantity> quantities_;
  std::vector<std::string> names_;          ///< names in the header; empty if there is no header
  std::vector<std::string> plain_names_;    ///< as plain_name() has them
  std::vector<std::string_view> units_;     ///< of the header, known ones; empty: none
  std::vector<std::string> strange_units_;  ///< in a row of units, not known
  std::size_t field_count_ = 0;
  bool first_line_is_header_ = false;
  std::vector<BoundColumn> columns_;
  std::vector<std::string> notes_;
  std::vector<std::string> by_default_;  ///< quantities that were found by their default names
  std::optional<std::size_t> filtered_;
};

/// Returns the reason why no table can satisfy a column request ("unknown unit 'kmh' for speed; did
/// you mean 'km/h'?"). Empty if the request is well formed.
[[nodiscard]] std::string column_request_error(const Quantity& quantity, const ColumnRequest& request);

/// Reads a number, also with a leading '+'. NaN if the field is empty, "nan", "na", "n/a",
/// "null" or "none".
/// @param separator of the table: if it is no comma, a number may have a decimal comma
/// @return empty for anything else, also for infinities
[[nodiscard]] std::optional<double> number_from_field(std::string_view field, char separator);

/// Returns a number with a decimal comma with a point in its place. Empty for any other text.
[[nodiscard]] std::optional<std::string> with_decimal_point(std::string_view field);

}  // namespace waymark::formats
