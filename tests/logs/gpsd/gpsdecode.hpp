/// Runs the decoder of gpsd on a log, as an independent check.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <waymark/core/drive/log_reader.hpp>

namespace waymark_test {

/// Returns the objects that `gpsdecode -j` makes from a raw log. If the program (Debian package
/// gpsd-clients) or the log is missing, prints why the test is skipped and returns nothing.
[[nodiscard]] std::optional<std::vector<nlohmann::json>> run_gpsdecode(const std::filesystem::path& log);

/// Returns gpsd's objects from a text with one object per line, such as its regression outputs
/// (.chk). Other lines are skipped.
[[nodiscard]] std::vector<nlohmann::json> gpsd_objects(const std::string& text);

/// The differences between the fixes of a reader and those of gpsd.
struct Comparison {
  std::size_t ours = 0;
  std::size_t theirs = 0;   ///< TPV objects with a fix and a time
  std::size_t matched = 0;  ///< matched by time; only these are compared below
  std::size_t accuracies = 0;
  std::size_t other_dates = 0;  ///< matched ones whose date is off by a multiple of 1024 weeks
  /// The largest difference of positions.
  double position_m = 0;
  double height_m = 0;
  double time_s = 0;
  double speed_mps = 0;
  double course_deg = 0;
  double accuracy_m = 0;            ///< of the sigmas, if gpsd has a GST object with that time
  std::size_t qualities = 0;        ///< matched ones whose status gpsd tells
  std::size_t other_qualities = 0;  ///< of these, with another quality
  std::size_t ages = 0;             ///< matched ones with an age of corrections
  double age_s = 0;                 ///< largest difference
  /// fixes whose HDOP is that of the SKY object before or behind the report, and those with another one
  std::size_t same_hdop = 0, other_hdop = 0;
};

/// Tells whether a quality is what gpsd's `status` means (json, gpsd_json(5)).
[[nodiscard]] bool is_status(waymark::FixQuality quality, int status);

/// Compares fixes by time of day and week. A fix is matched with the object nearest in time, within
/// a millisecond, because gpsd gives milliseconds. Dates that differ by whole periods of 1024 weeks
/// are counted, not compared: gpsdecode has no clock to resolve them and moves dates of old logs
/// forward. @param fixes with stamps in UTC
[[nodiscard]] Comparison compare_with_gpsd(const std::vector<waymark::GeodeticFix>& fixes,
                                           const std::vector<nlohmann::json>& objects);

}  // namespace waymark_test
