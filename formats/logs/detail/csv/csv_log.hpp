/// Logs as tables of separated values (CSV, TSV, blanks), with a column map.
#pragma once

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// Reader "csv". formats/logs/README.md has the quantities with their default columns, units and senses.
///
/// A quantity is found by `request.columns` (a name of the header line, or a 1-based number), else by its
/// default column names; a quantity found so without being asked for is named in the notes. The header is the
/// first line that is neither blank nor comment, or the comment above it where that holds the names and the
/// line holds numbers; with numbers alone no header is needed.
///
/// Stamps are read exactly: decimal digits, never through a double. `gps_week`, then `time_offset_s` are
/// added.
///
/// Accuracy of a fix, in order of preference: sigma_east and sigma_north (1 sigma, with
/// covariance_en_signed_root where present: covariance = r |r|, RTKLIB's sdne), accuracy_east and
/// accuracy_north (automatic: 95 %), accuracy (automatic: drms). A figure that is missing, NaN, zero or
/// negative is none: the default sigma stands in, and is counted in the notes; without a default the line is
/// corrupt.
///
/// Corrupt lines are counted and the run goes on: another number of fields than the header has, a missing or
/// garbled number, a value outside its range (latitude, speed above 150 m/s, yaw rate above 20 rad/s, ...), a
/// covariance that is not positive definite. `valid` = 0 (also false, V, no) marks a line without a fix,
/// which is not corrupt.
///
/// @throws InputError (from read) for an empty log, one where nothing was usable, a column that does not
/// exist (with the columns present and the nearest), a quantity, unit or convention that does not exist,
/// fixes without any accuracy.
class CsvLogReader final : public LogReader {
 public:
  [[nodiscard]] std::unique_ptr<LogDecoder> open(const std::string& path,
                                                 const LogRequest& request) const override;
  /// Never surer than 0.5: most texts are some table.
  [[nodiscard]] Recognition recognise(std::string_view head) const override;
};

}  // namespace waymark::formats
