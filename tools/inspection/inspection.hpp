/// What is in a log, found in at most two passes over the file; memory does not grow with it.
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
#include <waymark/tools/inspection/survey/table_survey.hpp>
#include <waymark/tools/text/text_look.hpp>

namespace waymark::inspection {

/// How the stamps of a log are to be read, and why.
struct LogClock {
  TimeScale scale = TimeScale::utc;
  bool names_its_own = false;  ///< dates are in the log: nothing has to be stated
  bool dated = true;           ///< stamps are dates; else seconds of a week or since the start of something
  bool of_week = false;        ///< seconds of a GPS week
  bool known = true;           ///< by the log's format or the column's name; else assumed
  std::string reason;          ///< "column 't_unix_s' counts Unix seconds"
};

/// One log, looked at.
struct LogInspection {
  std::string path;
  std::uint64_t size = 0;  ///< bytes on the disk; of a folder all of them
  std::string format;
  std::string evidence;  ///< of the format; empty: it was stated
  std::map<std::string, std::string> companions;
  std::map<std::string, std::size_t> kinds;  ///< messages
  std::size_t records = 0, without_fix = 0, corrupt = 0;
  std::vector<std::string> corrupt_examples;
  std::vector<std::string> notes;     ///< of the readers
  std::vector<std::string> troubles;  ///< why a stream could not be read
  LogClock clock;
  std::optional<TableSummary> table;
  std::optional<CanSummary> can;
  std::optional<FixSummary> fixes;  ///< also of a truth
  std::optional<OdometrySummary> odometry;
  std::optional<double> logger_ahead_s;  ///< its stamps against the GNSS time told in it, median
  std::vector<std::string> suspicions;   ///< one sentence each

  /// Span of all stamps found; empty without any.
  [[nodiscard]] const StampSeries* span() const;
};

struct InspectionOptions {
  std::string format = "auto";
  std::string dbc;  ///< file; empty: none
  /// Told of each piece read: file, bytes done, bytes in all.
  std::function<void(const std::string&, std::uint64_t, std::uint64_t)> watch{};
  Stamp now{};  ///< UTC: later dates are suspicious
};

/// @throws InputError for a file that cannot be read, is empty or of no known format. What only one stream
/// of it does not survive is in LogInspection::troubles.
[[nodiscard]] LogInspection inspect_log(const std::string& path, std::span<const LogReaderType> readers,
                                        const InspectionOptions& options);

/// Several: what only shows side by side (clocks apart) goes into the suspicions of the later one. Undated
/// tables whose seconds fit into the week of a dated log are taken for seconds of that week.
[[nodiscard]] std::vector<LogInspection> inspect_logs(const std::vector<std::string>& paths,
                                                      std::span<const LogReaderType> readers,
                                                      const InspectionOptions& options);

/// The columns proposed for a stream of a table or a bus, by quantity.
[[nodiscard]] std::map<std::string, const ColumnSummary*> proposed_columns(const LogInspection& log,
                                                                           StreamKind stream);
/// "2021-07-26T04:40:55.124Z", or seconds where the clock has no date.
[[nodiscard]] std::string date_text(Stamp stamp, const LogClock& clock);

/// For people.
[[nodiscard]] std::string inspection_text(const LogInspection& log, const text::TextLook& look = {});
[[nodiscard]] nlohmann::ordered_json inspection_json(const LogInspection& log);

}  // namespace waymark::inspection
