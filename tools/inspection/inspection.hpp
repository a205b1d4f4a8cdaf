/// Finds out what a log contains, in at most two passes over the file. Memory does not grow
/// with the file.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <waymark/core/drive/log_reader.hpp>
#include <waymark/tools/inspection/survey/can_survey.hpp>
#include <waymark/tools/inspection/survey/fix_statistics.hpp>
#include <waymark/tools/inspection/survey/odometry_statistics.hpp>
#include <waymark/tools/inspection/survey/raw_survey.hpp>
#include <waymark/tools/inspection/survey/table_survey.hpp>
#include <waymark/tools/text/text_look.hpp>

namespace waymark::inspection {

/// How the stamps of a log are read, and why.
struct LogClock {
  TimeScale scale = TimeScale::utc;
  bool names_its_own = false;  ///< the log contains dates, so the user need not state the clock
  /// stamps are dates; else they are seconds of a week or since some start
  bool dated = true;
  bool of_week = false;  ///< seconds of a GPS week
  /// known from the format of the log or the name of the column; else assumed
  bool known = true;
  std::string reason;  ///< "column 't_unix_s' counts Unix seconds"
};

/// The result for one log.
struct LogInspection {
  std::string path;
  std::uint64_t size = 0;  ///< bytes on the disk; for a folder, of all its files
  std::string format;
  std::string evidence;  ///< why this format; empty: the user stated it
  std::map<std::string, std::vector<std::string>> companions;
  std::map<std::string, std::size_t> kinds;  ///< messages of each kind
  std::size_t records = 0, without_fix = 0, corrupt = 0;
  std::vector<std::string> corrupt_examples;
  std::vector<std::string> notes;     ///< of the readers
  std::vector<std::string> troubles;  ///< why a stream could not be read
  LogClock clock;
  std::optional<TableSummary> table;
  std::optional<CanSummary> can;
  std::optional<FixSummary> fixes;  ///< also for a truth
  std::optional<OdometrySummary> odometry;
  std::optional<RawSummary> raw{};       ///< of satellites
  std::optional<double> logger_ahead_s;  ///< its stamps minus the GNSS time in it, median
  std::vector<std::string> suspicions;   ///< one sentence each

  /// Returns the span of all stamps; null without stamps.
  [[nodiscard]] const StampSeries* span() const;
};

struct InspectionOptions {
  std::string format = "auto";
  std::vector<std::string> dbc;  ///< files
  /// Called for each piece that is read: file, bytes done, bytes in all.
  std::function<void(const std::string&, std::uint64_t, std::uint64_t)> watch{};
  Stamp now{};  ///< UTC; later dates are suspicious
};

/// @throws InputError for a file that cannot be read, is empty or has no known format. If only one
/// stream fails, LogInspection::troubles says so.
[[nodiscard]] LogInspection inspect_log(const std::string& path, std::span<const LogReaderType> readers,
                                        const InspectionOptions& options);

/// Inspects several logs. A suspicion that needs two logs (clocks apart) is reported with the later
/// one. An undated table is read as seconds of the week of a dated log if its seconds fit into it.
[[nodiscard]] std::vector<LogInspection> inspect_logs(const std::vector<std::string>& paths,
                                                      std::span<const LogReaderType> readers,
                                                      const InspectionOptions& options);

/// Returns the columns that are proposed for a stream of a table or a bus, by quantity.
[[nodiscard]] std::map<std::string, const ColumnSummary*> proposed_columns(const LogInspection& log,
                                                                           StreamKind stream);
/// Returns what the accuracy among such columns means by its name. Those of axes come before it, and their names tell
/// nothing of it.
[[nodiscard]] AccuracyMeaning named_meaning(const std::map<std::string, const ColumnSummary*>& columns);
/// Returns the column that tells the receivers of a table apart; null if there is none. Only the rows of the first
/// one are read.
[[nodiscard]] const ColumnSummary* receiver_column(const LogInspection& log);
/// Returns "2021-07-26T04:40:55.124Z", or seconds if the clock has no date.
[[nodiscard]] std::string date_text(Stamp stamp, const LogClock& clock);

/// Returns the result as text for people.
[[nodiscard]] std::string inspection_text(const LogInspection& log, const text::TextLook& look = {});
[[nodiscard]] nlohmann::ordered_json inspection_json(const LogInspection& log);

}  // namespace waymark::inspection
