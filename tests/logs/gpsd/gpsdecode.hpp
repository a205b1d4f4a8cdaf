/// The decoder of gpsd, run on a log: an independent opinion.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <waymark/core/drive/log_reader.hpp>

namespace waymark_test {

/// What `gpsdecode -j` makes of a raw log, object by object; empty, with a line that says why the test is
/// skipped, where the program (Debian package gpsd-clients) or the log is absent.
[[nodiscard]] std::optional<std::vector<nlohmann::json>> run_gpsdecode(const std::filesystem::path& log);

/// gpsd's objects in a text of one object a line, such as its regression outputs (.chk); other lines are
/// passed over.
[[nodiscard]] std::vector<nlohmann::json> gpsd_objects(const std::string& text);

/// How far the fixes of a reader are from gpsd's.
struct Comparison {
  std::size_t ours = 0;
  std::size_t theirs = 0;   ///< TPV objects with a fix and a time
  std::size_t matched = 0;  ///< by time, of which the date is compared below
  std::size_t accuracies = 0;
  std::size_t other_dates = 0;  ///< matched ones whose date is off by a multiple of 1024 weeks
  /// Largest differences.
  double position_m = 0;
  double height_m = 0;
  double time_s = 0;
  double speed_mps = 0;
  double course_deg = 0;
  double accuracy_m = 0;  ///< of the sigmas, where gpsd has a GST object of that time
};

/// Compares by time of day and week; a fix is matched to the object nearest in time, within a millisecond, as
/// gpsd gives milliseconds. Dates that differ by whole periods of 1024 weeks are counted, not compared:
/// gpsdecode has no clock to resolve them and moves dates of old logs forward. @param fixes  stamps are UTC
[[nodiscard]] Comparison compare_with_gpsd(const std::vector<waymark::GeodeticFix>& fixes,
                                           const std::vector<nlohmann::json>& objects);

/// One row of the table that the tests tagged [.table] print.
[[nodiscard]] std::string table_row(const std::string& name, const Comparison& comparison);
[[nodiscard]] std::string table_head();

}  // namespace waymark_test
