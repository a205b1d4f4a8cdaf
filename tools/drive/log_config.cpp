#include <waymark/tools/drive/log_config.hpp>

#include <array>
#include <filesystem>

#include <fmt/format.h>

#include <waymark/core/error.hpp>
#include <waymark/formats/logs/csv_columns.hpp>
#include <waymark/formats/logs/quantity.hpp>
#include <waymark/formats/suggest.hpp>

namespace waymark {
namespace {

constexpr std::array<std::string_view, 3> kScales{"gps", "utc", "unix"};
constexpr std::array<std::string_view, 5> kMeanings{"auto", "95", "1sigma", "drms", "cep50"};
constexpr std::array kMeaningValues{AccuracyMeaning::automatic, AccuracyMeaning::percent95,
                                    AccuracyMeaning::one_sigma, AccuracyMeaning::drms,
                                    AccuracyMeaning::cep50};
constexpr std::array<std::string_view, 7> kSeparators{",", ";", "tab", "blank", "comma", "semicolon", "\t"};
constexpr std::array kSeparatorValues{',', ';', '\t', ' ', ',', ';', '\t'};
constexpr NumberRule kWeek{0, 9999, "a GPS week from 0 to 9999"};
constexpr NumberRule kOffset{-1e9, 1e9, "a number of seconds"};

ColumnRequest read_column(const YamlSection& columns, const std::string& key) {
  ColumnRequest request;
  if (!columns.node(key).IsMap()) {
    columns.read(key, request.column);
    return request;
  }
  const YamlSection spec = *columns.section(key, {"column", "unit", "convention"});
  spec.read("column", request.column);
  spec.read("unit", request.unit);
  spec.read("convention", request.convention);
  return request;
}

void read_columns(const YamlSection& section, LogRequest& request) {
  if (!section.has("columns")) return;
  const bool of_sensor = request.stream == StreamKind::sensor;  // only its plugin knows the quantities
  const std::vector<Quantity> known = quantities(request);
  const YamlSection columns =
      of_sensor ? *section.free_section("columns")
                : YamlSection(section.node("columns"), "columns", section.file(), names_of(known));
  for (const std::string& key : columns.keys()) {
    request.columns[key] = read_column(columns, key);
    if (of_sensor) continue;
    const Quantity& quantity = *find_quantity(known, key);
    if (const std::string error = column_request_error(quantity, request.columns[key]); !error.empty())
      throw InputError(columns.place(key) + error);
  }
}

void read_time(const YamlSection& section, LogRequest& request) {
  const auto time = section.section("time", {"scale", "week", "offset"});
  if (!time) return;
  if (const auto scale = time->read_word("scale", kScales))
    request.time_scale = *time_scale_from_string(kScales[*scale]);
  time->read("week", request.gps_week, kWeek);
  time->read("offset", request.time_offset_s, kOffset);
  if (request.gps_week != 0 && request.time_scale != TimeScale::gps)
    time->fail("week", "a week belongs to the scale gps");
}

}  // namespace

LogConfig read_log_config(const YamlSection& section, StreamKind stream, const std::string& folder,
                          TimeScale drive_scale) {
  LogConfig log;
  log.place = section.place();
  log.request.stream = stream;
  log.request.time_scale = drive_scale;
  std::string file;
  section.read("file", file);
  if (file.empty()) throw InputError(fmt::format("{}{}: 'file' is missing", log.place, to_string(stream)));
  log.file = (std::filesystem::path(folder) / file).lexically_normal().string();
  section.read("format", log.format);
  if (log.format != "csv") {
    for (const std::string_view key : {"columns", "separator"}) {
      if (section.has(key))
        section.fail(key, fmt::format("belongs to the format csv, not to {}", log.format));
    }
  }
  if (const auto separator = section.read_word("separator", kSeparators))
    log.request.separator = kSeparatorValues[*separator];
  read_columns(section, log.request);
  read_time(section, log.request);
  if (const auto accuracy = section.section("accuracy", {"meaning", "default_sigma"})) {
    if (const auto meaning = accuracy->read_word("meaning", kMeanings))
      log.request.accuracy = kMeaningValues[*meaning];
    accuracy->read("default_sigma", log.request.default_sigma_m, kNotNegative);
  }
  return log;
}

}  // namespace waymark
