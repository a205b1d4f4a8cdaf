#include <waymark/tools/inspection/inspection.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/suggest.hpp>
#include <waymark/formats/logs/channels.hpp>
#include <waymark/formats/logs/detail/can/dbc_set.hpp>
#include <waymark/formats/logs/detail/can/layouts/can_layout.hpp>
#include <waymark/formats/logs/detail/csv/composed.hpp>
#include <waymark/formats/logs/log_file.hpp>
#include <waymark/tools/inspection/log_clock.hpp>
#include <waymark/tools/inspection/suspicions.hpp>

namespace waymark::inspection {
namespace {

/// Any date: logs without a date can then be read all the same.
constexpr Stamp kAnyDate{946'684'800'000'000'000};

/// A stream that is read from the log, and the destination of its samples.
struct Pass {
  std::unique_ptr<LogDecoder> decoder;
  std::function<void(LogData&)> drain;
  std::string trouble;
  bool over = false;
};

/// Runs a step. An error of the decoder ends its pass, not the inspection.
template <typename Step>
void guarded(Pass& pass, Step step) {
  if (pass.over || !pass.decoder) return;
  try {
    step(*pass.decoder);
  } catch (const InputError& error) {
    pass.trouble = error.what();
    pass.over = true;
  }
  if (pass.drain) pass.drain(pass.decoder->data());
}

void read_passes(const std::string& path, std::span<Pass* const> passes, const InspectionOptions& options,
                 LogInspection& log) {
  const formats::ReadProgress progress = [&](std::uint64_t done, std::uint64_t size) {
    if (options.watch) options.watch(path, done, size);
  };
  const std::string trouble = formats::read_in_pieces(
      path,
      [&](std::string_view piece) {
        for (Pass* pass : passes) guarded(*pass, [&](LogDecoder& decoder) { decoder.take(piece); });
      },
      progress);
  for (Pass* pass : passes) guarded(*pass, [](LogDecoder& decoder) { decoder.finish(); });
  if (!trouble.empty() && log.troubles.empty()) log.troubles.push_back(path + ": " + trouble);
}

std::uint64_t size_of(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(path, ignored)) {
    const auto size = std::filesystem::file_size(path, ignored);
    return ignored ? 0 : size;
  }
  std::uint64_t size = 0;
  for (const auto& entry : std::filesystem::directory_iterator(path, ignored))
    if (entry.is_regular_file(ignored)) size += entry.file_size(ignored);
  return size;
}

LogReaderType reader_for(const std::string& path, std::span<const LogReaderType> readers,
                         const InspectionOptions& options, LogInspection& log) {
  if (options.format == "auto") {
    const formats::Recognised found = formats::recognise_log(path, readers);
    log.evidence = found.why.evidence;
    return found.reader;
  }
  std::vector<std::string_view> names;
  for (const LogReaderType& reader : readers) {
    if (reader.name == options.format) return reader;
    names.push_back(reader.name);
  }
  throw UsageError("unknown log format '" + options.format + "'" + suggestion(options.format, names));
}

/// Finds the files that belong to the log: the given DBC, or the stamps beside a KITTI folder.
void find_companions(LogInspection& log, const InspectionOptions& options) {
  if (formats::is_can_format(log.format) && !options.dbc.empty()) log.companions["dbc"] = options.dbc;
  const std::filesystem::path beside = std::filesystem::path(log.path).parent_path() / "timestamps.txt";
  std::error_code unknown;
  if (log.format == "kitti_oxts" && std::filesystem::is_directory(log.path, unknown) &&
      std::filesystem::exists(beside, unknown))
    log.companions["timestamps"] = {beside.string()};
}

LogRequest basic_request(const LogInspection& log, StreamKind stream) {
  LogRequest request;
  request.stream = stream;
  request.time_scale = log.clock.scale;
  request.default_sigma_m = kNoAccuracy;
  for (const FixQuality quality : kFixQualities) request.sigma_by_quality[quality] = kNoAccuracy;
  if (stream == StreamKind::odometry) request.readings = formats::odometry_channels();
  if (log.table) {
    request.date = kAnyDate;
    if (const ColumnSummary* column = receiver_column(log))
      request.where = RowFilter{column->name, column->receivers.front(), true};
  }
  for (const auto& [key, paths] : log.companions)
    for (const std::string& path : paths) request.companions[key].push_back(formats::read_companion(path));
  return request;
}

/// Tells whether a log of columns holds the stream, and adds its columns to the request.
bool map_columns(const LogInspection& log, LogRequest& request) {
  const auto columns = proposed_columns(log, request.stream);
  for (const auto& [quantity, column] : columns)
    request.columns[quantity] = {reference_of(*column), column->proposal.unit, column->proposal.convention,
                                 column->proposal.scale, column->proposal.missing};
  request.accuracy = named_meaning(columns);
  if (request.stream == StreamKind::gnss)
    return (columns.contains("latitude") && columns.contains("longitude")) ||
           (columns.contains("ecef_x") && columns.contains("ecef_y") && columns.contains("ecef_z"));
  return columns.size() > (log.table ? 1U : 0U);
}

/// The first pass over a log of columns: it finds the columns.
void survey(LogInspection& log, const InspectionOptions& options) {
  Pass pass;
  if (log.format == "csv")
    pass.decoder = std::make_unique<TableSurvey>(log.path);
  else
    pass.decoder = std::make_unique<CanSurvey>(log.path, log.format,
                                               formats::dbc_of(basic_request(log, StreamKind::gnss)));
  Pass* const passes[] = {&pass};
  read_passes(log.path, passes, options, log);
  const LogData& data = pass.decoder->data();
  log.records = data.records;
  log.corrupt = data.corrupt;
  log.corrupt_examples = data.corrupt_examples;
  log.kinds = data.kinds;
  if (log.format == "csv") {
    log.table = dynamic_cast<TableSurvey&>(*pass.decoder).summary();
    const auto proposed = [&log](std::string_view quantity) -> const ColumnSummary* {
      for (const ColumnSummary& column : log.table->columns)
        if (column.proposal.quantity == quantity) return &column;
      return nullptr;
    };
    log.clock = clock_of_column(proposed("time"), proposed("date"), options.now);
  } else {
    log.can = dynamic_cast<CanSurvey&>(*pass.decoder).summary();
    const bool since_start = log.can->stamps.earliest().seconds() < 0.9e9;
    log.clock = {TimeScale::unix_time,
                 false,
                 !since_start,
                 false,
                 !since_start && log.format == "candump",
                 since_start               ? "the logger counts from an unknown start"
                 : log.format == "candump" ? "the logger's clock, Unix seconds"
                                           : "the date in the log's head, local time of an unknown zone"};
  }
}

/// Adds the notes of a pass, except those about the sigma that only the inspection requested.
void add_notes(LogInspection& log, const LogData& data) {
  for (const std::string& note : data.notes) {
    if (note.find("999999") != std::string::npos || note.find("by default") != std::string::npos) continue;
    if (std::find(log.notes.begin(), log.notes.end(), note) == log.notes.end()) log.notes.push_back(note);
  }
}

void add_counts(LogInspection& log, const LogData& data) {
  log.records = data.records;
  log.without_fix = data.without_fix;
  log.corrupt = data.corrupt;
  log.corrupt_examples = data.corrupt_examples;
}

/// Opens a pass and keeps an error as its trouble. The counts tell later whether the log only lacks
/// odometry, or something is wrong.
void open(Pass& pass, const LogReader& reader, const std::string& path, const LogRequest& request) {
  try {
    pass.decoder = reader.open(path, request);
  } catch (const InputError& error) {
    pass.trouble = error.what();
  }
}

/// Counts the satellites of a log of raw measurements.
/// @return the counts of its decoder
template <typename Survey>
LogData survey_raw(LogInspection& log, const InspectionOptions& options) {
  Pass pass;
  auto survey = std::make_unique<Survey>(log.path);
  const RawSummarySource& raw = *survey;
  pass.decoder = std::move(survey);
  Pass* const passes[] = {&pass};
  read_passes(log.path, passes, options, log);
  if (!pass.trouble.empty()) log.troubles.push_back(pass.trouble);
  if (raw.summary().stamps.count() > 0) log.raw = raw.summary();
  return std::move(pass.decoder->data());
}

/// An observation file has nothing but raw measurements.
void survey_rinex(LogInspection& log, const InspectionOptions& options) {
  add_counts(log, survey_raw<RinexSurvey>(log, options));
  if (!log.raw) return;
  log.clock.reason = "RINEX names its dates; shown in UTC";
  log.notes.push_back("raw measurements need the broadcast ephemerides of the day: gnss: {file: " + log.path +
                      ", navigation: FILE}");
}

/// A UBX log may have raw measurements beside its fixes, and ephemerides beside these.
void survey_raw_ubx(LogInspection& log, const InspectionOptions& options) {
  const LogData data = survey_raw<UbxRawSurvey>(log, options);
  const bool nothing_else = (!log.fixes || log.fixes->fixes == 0) && !log.odometry;
  if (nothing_else) add_counts(log, data);
  if (!log.raw) return;
  std::vector<std::string> without;
  for (const auto& [name, satellite] : log.raw->satellites)
    if (satellite.pseudoranges > 0 && satellite.ephemerides == 0) without.push_back(name);
  if (!without.empty())
    log.notes.push_back(fmt::format(
        "the log has no ephemeris of {}: such satellites need 'navigation: FILE' beside 'file: {}'",
        fmt::join(without, ", "), log.path));
}

class StreamReading {
 public:
  StreamReading(LogInspection& log, const LogReader& reader, const InspectionOptions& options)
      : log_(log), reader_(reader), options_(options), motion_(formats::odometry_channels()) {}

  void read(std::optional<Stamp> date) {
    Pass gnss, odometry;
    LogRequest positions = basic_request(log_, StreamKind::gnss);
    LogRequest motions = basic_request(log_, StreamKind::odometry);
    if (date) positions.date = date;
    const bool of_columns = log_.table || log_.can;
    if (!of_columns || map_columns(log_, positions)) open(gnss, reader_, log_.path, positions);
    if (log_.table && has_whole_odometry()) motions.readings.clear();
    if (!of_columns || map_columns(log_, motions)) open(odometry, reader_, log_.path, motions);
    std::vector<Pass*> passes;
    gnss.drain = [this](LogData& data) { take_fixes(data); };
    odometry.drain = [this](LogData& data) { take_motion(data); };
    if (gnss.decoder) passes.push_back(&gnss);
    if (odometry.decoder) passes.push_back(&odometry);
    if (passes.empty()) return;
    read_passes(log_.path, passes, options_, log_);
    finish(gnss, odometry);
  }

 private:
  [[nodiscard]] bool has_whole_odometry() const {
    const auto columns = proposed_columns(log_, StreamKind::odometry);
    return columns.size() == 3 && columns.contains("speed") && columns.contains("yaw_rate");
  }
  void take_fixes(LogData& data) {
    for (const GeodeticFix& fix : data.fixes) fixes_.add(fix);
    fix_count_ += data.fixes.size();
    data.fixes.clear();
    for (const ClockPair& pair : data.clocks) ahead_.add(pair.logged.seconds() - pair.told.seconds());
    data.clocks.clear();
  }
  void take_motion(LogData& data) {
    for (const OdometrySample& sample : data.odometry) motion_.add(sample);
    motion_.add(data.readings);
    motion_count_ += data.odometry.size() + data.readings.size();
    data.odometry.clear();
    data.readings.stamps.clear();
    data.readings.values.clear();
    data.clocks.clear();
  }
  void finish(const Pass& gnss, const Pass& odometry) {
    const auto counts_of = [&](const Pass& pass, bool main) {
      const LogData& data = pass.decoder->data();
      add_notes(log_, data);
      if (main) add_counts(log_, data);
      for (const auto& [kind, count] : data.kinds) log_.kinds[kind] = std::max(log_.kinds[kind], count);
    };
    const bool positions_first = gnss.decoder && (fix_count_ > 0 || motion_count_ == 0);
    if (gnss.decoder) counts_of(gnss, positions_first);
    if (odometry.decoder && motion_count_ > 0) counts_of(odometry, !positions_first);
    // The log of a receiver without odometry reports this by an error, and nothing is wrong.
    if (!gnss.trouble.empty() && (fix_count_ == 0 || gnss.over)) log_.troubles.push_back(gnss.trouble);
    if (!odometry.trouble.empty() && (motion_count_ > 0 || log_.table || log_.can))
      log_.troubles.push_back(odometry.trouble);
    if (fix_count_ > 0 || (gnss.decoder && motion_count_ == 0)) log_.fixes = fixes_.summary();
    if (motion_count_ > 0) log_.odometry = motion_.summary();
    if (ahead_.count() > 0) log_.logger_ahead_s = ahead_.median();
  }

  LogInspection& log_;
  const LogReader& reader_;
  const InspectionOptions& options_;
  FixStatistics fixes_;
  OdometryStatistics motion_;
  EvenSample ahead_;
  std::size_t fix_count_ = 0, motion_count_ = 0;
};

void read_streams(LogInspection& log, const LogReader& reader, const InspectionOptions& options) {
  StreamReading(log, reader, options).read(std::nullopt);
  const bool nothing = (!log.fixes || log.fixes->fixes == 0) && !log.odometry;
  if (!nothing || log.format != "nmea" || log.records == log.without_fix) return;
  // The log may only lack a date.
  LogInspection again = log;
  again.troubles.clear();
  again.notes.clear();
  StreamReading(again, reader, options).read(kAnyDate);
  if (!again.fixes || again.fixes->fixes == 0) return;
  again.clock.known = false;
  again.clock.reason =
      "the log has only the time of day; the date shown is invented, state 'date' under 'time'";
  again.clock.names_its_own = false;
  log = std::move(again);
}

bool is_stream_quantity(std::string_view quantity, StreamKind stream) {
  LogRequest request;
  request.stream = stream;
  if (stream == StreamKind::odometry) request.readings = formats::odometry_channels();
  const std::vector<formats::Quantity> known = formats::table_quantities(request);
  return formats::find_quantity(known, quantity) != nullptr;
}

/// The heading of a receiver is its course: clockwise from north and within one turn. A heading
/// that runs on over full turns, or counts from east, comes from a reference system.
bool heading_is_course(const ColumnSummary& column) {
  const double turn = column.proposal.unit == "rad" ? 6.2832 : 360;
  return column.proposal.convention != "ccw_from_east" && column.range.smallest >= -turn &&
         column.range.largest <= turn;
}

/// Reads an undated table as seconds of the week of another log, if the numbers fit.
void adopt_week(LogInspection& log, const LogInspection& other) {
  if (log.clock.dated || log.clock.of_week || log.span() == nullptr || other.span() == nullptr) return;
  if (!other.clock.dated && !other.clock.of_week) return;
  const auto second = [&](Stamp stamp) {
    return other.clock.dated ? week_second(stamp, other.clock).second : stamp.seconds();
  };
  const double begin = second(other.span()->earliest());
  const double end = begin + other.span()->span_s();
  if (log.span()->latest().seconds() < begin || log.span()->earliest().seconds() > end) return;
  // seconds that count from the start of the log fit by chance
  if (log.span()->earliest().seconds() < 600) return;
  log.clock.of_week = true;
  log.clock.scale = TimeScale::gps;
  log.clock.known = false;
  log.clock.reason = fmt::format("its numbers are like the seconds of the GPS week in {}",
                                 std::filesystem::path(other.path).filename().string());
}

/// Reads assumed Unix seconds of a table as GPS seconds since 1980 if only they fit the dates of another log.
void adopt_gps_epoch(LogInspection& log, const LogInspection& other) {
  const bool assumed =
      log.table && !log.clock.known && log.clock.dated && log.clock.scale == TimeScale::unix_time;
  if (!assumed || !other.clock.dated || !other.clock.known) return;
  if (log.span() == nullptr || other.span() == nullptr) return;
  const auto overlaps = [&](TimeScale scale) {
    const auto seconds = [&](Stamp stamp) { return on_scale(stamp, scale, TimeScale::utc).seconds(); };
    const auto told = [&](Stamp stamp) {
      return on_scale(stamp, other.clock.scale, TimeScale::utc).seconds();
    };
    return seconds(log.span()->earliest()) <= told(other.span()->latest()) &&
           seconds(log.span()->latest()) >= told(other.span()->earliest());
  };
  if (overlaps(TimeScale::unix_time) || !overlaps(TimeScale::gps)) return;
  log.clock.scale = TimeScale::gps;
  log.clock.reason = fmt::format("its numbers are GPS seconds since 1980 by the dates of {}",
                                 std::filesystem::path(other.path).filename().string());
}

}  // namespace

const StampSeries* LogInspection::span() const {
  if (fixes && fixes->fixes > 0) return &fixes->stamps;
  if (odometry) return &odometry->stamps;
  if (can && can->frames > 0) return &can->stamps;
  if (raw) return &raw->stamps;
  return nullptr;
}

const ColumnSummary* receiver_column(const LogInspection& log) {
  if (!log.table) return nullptr;
  for (const ColumnSummary& column : log.table->columns)
    if (!column.receivers.empty()) return &column;
  return nullptr;
}

AccuracyMeaning named_meaning(const std::map<std::string, const ColumnSummary*>& columns) {
  const auto column = columns.find("accuracy");
  const bool has_axes = columns.contains("sigma_east") || columns.contains("accuracy_east");
  return column == columns.end() || has_axes ? AccuracyMeaning::automatic : column->second->proposal.meaning;
}

std::map<std::string, const ColumnSummary*> proposed_columns(const LogInspection& log, StreamKind stream) {
  std::map<std::string, const ColumnSummary*> columns;
  static const std::vector<ColumnSummary> kNone;
  const std::vector<ColumnSummary>& all = log.table ? log.table->columns : log.can ? log.can->signals : kNone;
  for (const ColumnSummary& column : all) {
    std::string quantity = column.proposal.quantity;
    if (stream == StreamKind::gnss && quantity == "heading")
      quantity = heading_is_course(column) ? "course" : "";
    if (quantity.empty() || !is_stream_quantity(quantity, stream)) continue;
    if (log.can && formats::find_piece(quantity) != nullptr) continue;  // only tables compose
    // The speed of a receiver on the bus is not odometry.
    if (log.can && stream == StreamKind::odometry && quantity == "speed" && is_of_receiver(column.name))
      continue;
    if (log.can && stream == StreamKind::gnss && quantity == "speed" && !is_of_receiver(column.name))
      continue;
    columns.emplace(quantity, &column);
  }
  // Pieces serve where the whole is not there, all together.
  const bool has_whole = stream == StreamKind::gnss ? columns.contains("speed") && columns.contains("course")
                                                    : columns.contains("speed");
  if (has_whole || !columns.contains("velocity_east") || !columns.contains("velocity_north"))
    for (const char* component : {"velocity_east", "velocity_north"}) columns.erase(component);
  const bool in_degrees = columns.contains("latitude") && columns.contains("longitude");
  if (in_degrees || !columns.contains("ecef_x") || !columns.contains("ecef_y") || !columns.contains("ecef_z"))
    for (const char* coordinate : {"ecef_x", "ecef_y", "ecef_z"}) columns.erase(coordinate);
  else
    for (const char* coordinate : {"latitude", "longitude"}) columns.erase(coordinate);
  // A single speed beside positions is that of the receiver.
  const bool speed_alone = columns.contains("speed") && columns.size() == 1U + columns.count("time");
  const auto is_latitude = [](const ColumnSummary& column) { return column.proposal.quantity == "latitude"; };
  if (log.table && stream == StreamKind::odometry && speed_alone &&
      std::any_of(all.begin(), all.end(), is_latitude))
    columns.clear();
  return columns;
}

LogInspection inspect_log(const std::string& path, std::span<const LogReaderType> readers,
                          const InspectionOptions& options) {
  LogInspection log;
  log.path = path;
  log.size = size_of(path);
  const LogReaderType reader = reader_for(path, readers, options, log);
  log.format = reader.name;
  log.clock = {TimeScale::utc, true, true, false, true, "the log names its dates"};
  find_companions(log, options);
  if (log.format == "csv" || formats::is_can_format(log.format)) survey(log, options);
  if (log.format == "rinex") {
    survey_rinex(log, options);
    log.suspicions = suspicions_of(log, options.now);
    return log;
  }
  const bool without_signals = log.can && log.can->signals.empty();
  if (!without_signals) read_streams(log, *reader.reader, options);
  if (log.format == "ubx" && log.kinds.contains("RXM-RAWX")) survey_raw_ubx(log, options);
  log.suspicions = suspicions_of(log, options.now);
  return log;
}

std::vector<LogInspection> inspect_logs(const std::vector<std::string>& paths,
                                        std::span<const LogReaderType> readers,
                                        const InspectionOptions& options) {
  std::vector<LogInspection> logs;
  for (const std::string& path : paths) logs.push_back(inspect_log(path, readers, options));
  for (LogInspection& log : logs) {
    for (const LogInspection& other : logs)
      if (&other != &log) {
        adopt_week(log, other);
        adopt_gps_epoch(log, other);
      }
  }
  for (std::size_t i = 1; i < logs.size(); ++i) {
    std::string sentence;
    for (std::size_t j = 0; j < i && sentence.empty(); ++j) {
      const bool both_of_week = logs[i].clock.of_week && (logs[j].clock.of_week || logs[j].clock.dated);
      const bool week_after = logs[j].clock.of_week && logs[i].clock.dated;
      if (!both_of_week && !week_after) sentence = suspicion_between(logs[i], logs[j]);
    }
    if (!sentence.empty()) logs[i].suspicions.push_back(sentence);
  }
  return logs;
}

}  // namespace waymark::inspection
