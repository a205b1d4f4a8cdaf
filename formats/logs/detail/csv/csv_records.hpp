/// Reads samples from the lines of a table; private to the CSV reader.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/core/drive/log_reader.hpp>
#include <waymark/formats/logs/detail/common/gps_time.hpp>
#include <waymark/formats/logs/detail/common/position_stream.hpp>
#include <waymark/formats/logs/detail/common/record_fields.hpp>
#include <waymark/formats/logs/detail/common/table_accuracy.hpp>
#include <waymark/formats/logs/detail/csv/composed.hpp>
#include <waymark/formats/logs/detail/csv/counter_wraps.hpp>
#include <waymark/formats/logs/detail/csv/csv_bindings.hpp>
#include <waymark/formats/logs/detail/csv/csv_columns.hpp>
#include <waymark/formats/logs/detail/csv/table_time.hpp>
#include <waymark/formats/logs/detail/csv/unknown_marks.hpp>
#include <waymark/formats/logs/detail/place/utm.hpp>

namespace waymark::formats {

/// Reads the lines below the header; each is one record.
class CsvRecords {
 public:
  /// The columns, the path and the data must outlive the reader.
  /// @throws InputError for fixes without any accuracy
  CsvRecords(const CsvColumns& columns, const std::string& path, LogRequest request, LogData& data);

  /// @param line valid only during the call
  void read_line(std::string_view line, std::size_t number);
  void finish();

 private:
  /// The first error of the current line.
  struct Complaint {
    std::size_t column = 0;  ///< 0: none
    std::string what;
  };

  /// A position of the table, and the axes of its accuracy.
  struct Position {
    double latitude_deg = 0;
    double longitude_deg = 0;
    GridAxes axes{};
    double height_m = kNoNumber;  ///< of one that has a height itself
  };

  bool check_fields();
  [[nodiscard]] bool is_wanted() const;
  void read_sample();
  void read_truth(Stamp at);
  void read_fix(Stamp at);
  [[nodiscard]] bool read_details(GeodeticFix& fix);
  void read_readings(Stamp at);
  [[nodiscard]] std::optional<Stamp> instant(const BoundColumn& column);
  [[nodiscard]] std::optional<TableInstant> instant_of_day(const BoundColumn& column, std::string_view field);
  void require_date(const std::string& path) const;
  [[nodiscard]] std::optional<Stamp> stamp();
  [[nodiscard]] bool is_missing(const BoundColumn& column, std::string_view field) const;
  [[nodiscard]] double number(const BoundColumn* column, bool required);
  [[nodiscard]] std::optional<double> given_number(const BoundColumn& column, std::string_view field) const;
  [[nodiscard]] double angle(const BoundColumn* column, const BoundColumn* hemisphere);
  [[nodiscard]] std::optional<double> optional_number(const BoundColumn* column);
  [[nodiscard]] std::optional<double> optional_sigma(const BoundColumn* column);
  [[nodiscard]] bool has_fix();
  [[nodiscard]] std::optional<Position> position();
  [[nodiscard]] std::optional<Position> position_in_space();
  [[nodiscard]] double height_at(const Position& place);
  [[nodiscard]] double composed(Composed& way);
  [[nodiscard]] std::optional<double> optional_value(const BoundColumn* column, Composed& way);
  [[nodiscard]] bool add_fraction(Stamp& stamp);
  [[nodiscard]] std::optional<Position> position_on_grid(double easting_m, double northing_m);
  void set_covariance(GeodeticFix& fix, const GridAxes& axes);
  void complain(const BoundColumn& column, std::string what);
  void take_out_unknown();

  Bindings bound_;
  /// of a sensor, in the order of LogRequest::readings; null: there is no such column
  std::vector<const BoundColumn*> readings_;
  std::vector<Composed> composed_;  ///< of readings_ without a column of their own
  std::size_t field_count_;
  const std::string& path_;
  const LogRequest request_;
  LogData& data_;
  PositionStream positions_;
  AccuracyQuantities accuracy_;
  const BoundColumn *accuracy_east_ = nullptr, *accuracy_north_ = nullptr, *covariance_root_ = nullptr;
  std::int64_t offset_ = 0;
  Stamp last_of_day_{};                  ///< of a log without a column of dates
  std::int64_t days_ = 0;                ///< midnights since its first time of day
  WeekCount weeks_;                      ///< of a log whose times may be those of a week
  CounterWraps wraps_;                   ///< of a log whose times may be a counter of 32 bits
  Composed speed_, course_, heading_;    ///< of fixes and truth
  std::optional<std::size_t> filtered_;  ///< field that decides
  std::size_t unwanted_ = 0;
  UnknownMarks unknown_speed_, unknown_course_;
  std::size_t strange_qualities_ = 0;
  std::string strange_quality_;  ///< the first one

  std::string_view line_;
  std::size_t number_ = 0;
  std::vector<std::string_view> fields_;
  std::vector<double> row_;
  Complaint complaint_;
};

}  // namespace waymark::formats
