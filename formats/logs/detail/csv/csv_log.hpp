/// Logs as tables of separated values (CSV, TSV, blanks), with a column map.
#pragma once

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// Reader "csv". formats/logs/README.md lists the quantities with their default columns,
/// units and senses.
///
/// `request.columns` gives the column of a quantity by a name of the header line or by a 1-based
/// number. A quantity without an entry is searched by its default column names; a note names it if
/// it is found. The header is the first line that is neither blank nor a comment. It is the comment
/// above that line if the comment holds the names and the line holds numbers. If all columns are
/// given as numbers, no header is needed.
///
/// Stamps are read exactly: decimal digits, never a double. `gps_week` and then
/// `time_offset_s` are added.
///
/// The accuracy of a fix comes from the first of these that the table has: sigma_east and
/// sigma_north (1 sigma), accuracy_east and accuracy_north (automatic: 95 %), accuracy (automatic:
/// drms). covariance_en_signed_root (RTKLIB's sdne: covariance = r |r|) is used with the sigmas if
/// it is there. If a figure is missing, NaN, zero or negative, the default sigma replaces it, and
/// the notes count these lines. Without a default sigma such a line is corrupt.
///
/// Positions are latitude and longitude, or easting and northing in `metric_frame`; figures of
/// accuracy are then along the grid's axes. A line with neither coordinate is without a fix.
///
/// Quantities may be given in pieces (composed.hpp), and the table may begin below other lines (table_start.hpp).
///
/// Corrupt lines are counted and skipped. A line is corrupt if it has another number of fields than
/// the header, a missing or garbled number, a value outside its range (latitude, speed above 150
/// m/s, yaw rate above 20 rad/s, ...) or a covariance that is not positive definite. `valid` = 0
/// (also false, V, no) marks a line without a fix, which is not corrupt.
///
/// @throws InputError (from read) for an empty log, a log without usable lines, a column that does
/// not exist (the message lists the columns and the nearest name), a quantity, unit or convention
/// that does not exist, positions in metres without a frame, and fixes without any accuracy.
class CsvLogReader final : public LogReader {
 public:
  [[nodiscard]] std::unique_ptr<LogDecoder> open(const std::string& path,
                                                 const LogRequest& request) const override;
  /// The confidence is at most 0.5, because most texts are some table.
  [[nodiscard]] Recognition recognise(std::string_view head) const override;
};

}  // namespace waymark::formats
