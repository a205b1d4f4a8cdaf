#include <waymark/tools/drive/description/log_config.hpp>

#include <algorithm>
#include <array>
#include <filesystem>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/suggest.hpp>
#include <waymark/formats/logs/detail/can/layouts/can_layout.hpp>
#include <waymark/formats/logs/detail/common/quantity.hpp>
#include <waymark/formats/logs/detail/csv/composed.hpp>
#include <waymark/formats/logs/detail/csv/csv_columns.hpp>
#include <waymark/formats/text/iso8601.hpp>
#include <waymark/tools/drive/description/frame_entries.hpp>

namespace waymark::drive {
namespace {

constexpr std::array<std::string_view, 5> kMeanings{"auto", "95", "1sigma", "drms", "cep50"};
constexpr std::array kMeaningValues{AccuracyMeaning::automatic, AccuracyMeaning::percent95,
                                    AccuracyMeaning::one_sigma, AccuracyMeaning::drms,
                                    AccuracyMeaning::cep50};
constexpr std::array<std::string_view, 8> kSeparators{",",     ";",         "tab", "blank",
                                                      "comma", "semicolon", "\t",  "auto"};
constexpr std::array kSeparatorValues{',', ';', '\t', ' ', ',', ';', '\t', '\0'};
/// Keys of files that belong to a log.
constexpr std::array<std::string_view, 3> kCompanions{"dbc", "timestamps", "navigation"};
constexpr NumberRule kWeek{0, 9999, "a GPS week from 0 to 9999"};
constexpr NumberRule kOffset{-4e9, 4e9, "a number of seconds, at most 4e9"};

constexpr NumberRule kColumnScale{-1e12, 1e12, "a number other than 0"};

ColumnRequest read_column(const YamlSection& columns, const std::string& key) {
  ColumnRequest request;
  if (!columns.node(key).IsMap()) {
    columns.read(key, request.column);
    return request;
  }
  const YamlSection spec = *columns.section(key, {"column", "unit", "convention", "scale", "missing"});
  spec.read("column", request.column);
  spec.read("unit", request.unit);
  spec.read("convention", request.convention);
  spec.read("scale", request.scale, kColumnScale);
  if (request.scale == 0) spec.fail_value("scale", kColumnScale.words);
  spec.read("missing", request.missing, kAnyNumber);
  return request;
}

void read_columns(const YamlSection& section, const std::string& format, LogRequest& request) {
  if (!section.has("columns")) return;
  // Only the plugin of a sensor knows its quantities, and only its reader knows further names
  // of a format.
  const bool of_table = format == "csv" || format == "auto" || formats::is_can_format(format);
  const bool open = request.stream == StreamKind::sensor || !of_table;
  std::vector<formats::Quantity> known =
      formats::is_can_format(format) ? formats::quantities(request) : formats::table_quantities(request);
  const YamlSection columns =
      open ? *section.free_section("columns")
           : YamlSection(section.node("columns"), "columns", section.file(), formats::names_of(known));
  for (const std::string& key : columns.keys()) {
    request.columns[key] = read_column(columns, key);
    if (open) continue;
    const formats::Quantity& quantity = *formats::find_quantity(known, key);
    if (const std::string error = formats::column_request_error(quantity, request.columns[key]);
        !error.empty())
      throw InputError(columns.place(key) + error);
  }
}

/// Reads "2009-04-01" as UTC midnight.
void read_date(const YamlSection& time, LogRequest& request) {
  if (!time.has("date")) return;
  std::string text;
  time.read("date", text);
  request.date = formats::stamp_from_iso8601(text + "T00:00:00Z");
  if (!request.date) time.fail_value("date", "a date such as 2009-04-01");
}

void read_time(const YamlSection& section, LogRequest& request) {
  const auto time = section.section("time", {"scale", "week", "date", "offset"});
  if (!time) return;
  if (const auto scale = time->read_word("scale", kTimeScaleWords))
    request.time_scale = *time_scale_from_string(kTimeScaleWords[*scale]);
  time->read("week", request.gps_week, kWeek);
  read_date(*time, request);
  time->read("offset", request.time_offset_s, kOffset);
  if (request.gps_week != 0 && request.time_scale != TimeScale::gps)
    time->fail("week", "a week belongs to the scale gps");
}

void read_accuracy(const YamlSection& section, LogRequest& request) {
  const auto accuracy =
      section.section("accuracy", {"meaning", "default_sigma", "range_error", "by_quality"});
  if (!accuracy) return;
  if (const auto meaning = accuracy->read_word("meaning", kMeanings))
    request.accuracy = kMeaningValues[*meaning];
  accuracy->read("default_sigma", request.default_sigma_m, kNotNegative);
  if (request.default_sigma_m != 0) accuracy->read("default_sigma", request.default_sigma_m, kSigma);
  accuracy->read("range_error", request.range_error_m, kNotNegative);
  const auto by_quality = accuracy->free_section("by_quality");
  if (!by_quality) return;
  for (const std::string& word : by_quality->keys()) {
    const std::optional<FixQuality> quality = fix_quality_from_string(word);
    if (!quality)
      by_quality->fail(word,
                       "is no quality of a fix; known: unknown, single, differential, float, fixed, "
                       "dead_reckoned, manual, simulated");
    by_quality->read(word, request.sigma_by_quality[*quality], kSigma);
  }
}

/// The topic is a column of the log to its reader, as the quantities of a table are.
void read_topic(const YamlSection& section, LogConfig& log) {
  if (log.format != "mcap" && log.format != "rosbag" && log.format != "auto")
    section.fail("topic", fmt::format("belongs to the formats mcap and rosbag, not to {}", log.format));
  section.read("topic", log.request.columns["topic"].column);
  if (log.request.columns["topic"].column.empty()) section.fail_value("topic", "the name of a topic");
}

/// Reads "receiver == front" or "receiver != front".
RowFilter read_filter(const YamlSection& section) {
  std::string text;
  section.read("where", text);
  const auto trimmed = [](std::string_view part) {
    const auto begin = part.find_first_not_of(" \t");
    if (begin == std::string_view::npos) return std::string();
    return std::string(part.substr(begin, part.find_last_not_of(" \t") - begin + 1));
  };
  const std::size_t at = std::min(text.find("=="), text.find("!="));
  if (at == std::string::npos) section.fail_value("where", "COLUMN == VALUE or COLUMN != VALUE");
  RowFilter filter{trimmed(std::string_view(text).substr(0, at)),
                   trimmed(std::string_view(text).substr(at + 2)), text[at] == '='};
  if (filter.column.empty()) section.fail_value("where", "COLUMN == VALUE or COLUMN != VALUE");
  return filter;
}

std::string resolved(const std::string& folder, const std::string& file) {
  if (is_address(file)) return file;
  return (std::filesystem::path(folder) / file).lexically_normal().string();
}

}  // namespace

bool is_address(const std::string& file) {
  return file == "-" || file.find("://") != std::string::npos;
}

std::vector<std::string_view> log_keys(std::initializer_list<std::string_view> own) {
  std::vector<std::string_view> keys{"file", "format", "topic", "separator", "where", "columns", "time"};
  keys.insert(keys.end(), kCompanions.begin(), kCompanions.end());
  keys.insert(keys.end(), own);
  return keys;
}

LogConfig read_log_config(const YamlSection& section, LogRequest request, const std::string& folder,
                          TimeScale drive_scale) {
  LogConfig log;
  log.place = section.place();
  log.request = std::move(request);
  log.request.time_scale = drive_scale;
  std::string file;
  section.read("file", file);
  if (file.empty())
    throw InputError(
        fmt::format("{}{}: 'file' is missing", log.place, formats::to_string(log.request.stream)));
  log.file = resolved(folder, file);
  section.read("format", log.format);
  for (const char* key : {"separator", "where", "frame"})
    if (section.has(key) && log.format != "csv" && log.format != "auto" &&
        !(log.format == "gnss_logger" && key == std::string_view("where")))
      section.fail(key, fmt::format("belongs to the format csv, not to {}", log.format));
  for (const std::string_view key : kCompanions) {
    if (!section.has(key)) continue;
    std::vector<std::string> files;
    section.read(key, files);
    for (const std::string& path : files) log.companions[std::string(key)].push_back(resolved(folder, path));
  }
  if (section.has("where")) log.request.where = read_filter(section);
  if (const auto separator = section.read_word("separator", kSeparators))
    log.request.separator = kSeparatorValues[*separator];
  read_columns(section, log.format, log.request);
  if (section.has("topic")) read_topic(section, log);
  read_time(section, log.request);
  read_accuracy(section, log.request);
  read_log_frame(section, log.request);
  return log;
}

}  // namespace waymark::drive
