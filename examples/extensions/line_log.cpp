// A log reader: the text of a log becomes time-stamped samples. The format, one record per line:
//   O MILLISECONDS SPEED YAW_RATE               odometry, m/s and rad/s (counter-clockwise)
//   F MILLISECONDS LATITUDE LONGITUDE SIGMA     a fix, degrees (WGS84) and m per axis
#include <array>
#include <charconv>
#include <cmath>

#include <waymark/core/base/error.hpp>
#include <waymark/core/registry/plugin.hpp>

using namespace waymark;

/// Takes the next number off the line; false where there is none.
template <typename Number>
static bool take(std::string_view& line, Number& number) {
  line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), number);
  line.remove_prefix(static_cast<std::size_t>(end - line.data()));
  return error == std::errc() && std::isfinite(static_cast<double>(number));
}

/// Adds the sample of a line; false where the line is no record of this format.
static bool add_sample(std::string_view line, std::size_t line_number, const LogRequest& request,
                       LogData& data) {
  const bool is_fix = line[0] == 'F';
  line.remove_prefix(1);
  std::int64_t milliseconds = 0;
  std::array<double, 3> n{};
  bool sound = take(line, milliseconds) && std::abs(milliseconds) < 3'000'000'000'000;  // no overflow
  for (std::size_t i = 0; i < (is_fix ? 3U : 2U); ++i) sound = sound && take(line, n[i]);
  if (!sound || line.find_first_not_of(" \r") != line.npos) return false;
  if (is_fix && (std::abs(n[0]) > 90 || std::abs(n[1]) > 360 || n[2] <= 0)) return false;
  // The week and the offset that the drive.yaml states for this log.
  const std::int64_t week = request.gps_week * std::int64_t{604'800'000'000'000};
  const Stamp stamp{milliseconds * 1'000'000 + week + std::llround(request.time_offset_s * 1e9)};
  if (!is_fix) {
    data.odometry.push_back({stamp, n[0], n[1]});
    return true;
  }
  GeodeticFix& fix = data.fixes.emplace_back();
  fix.stamp = stamp;
  fix.latitude_deg = n[0];
  fix.longitude_deg = n[1];
  fix.covariance_en = n[2] * n[2] * Eigen::Matrix2d::Identity();
  fix.source = request.source;
  fix.line = line_number;
  return true;
}

/// Stateless: one reader serves any number of logs.
class LineLog final : public WholeLogReader {
 public:
  [[nodiscard]] LogData read_whole(std::string_view text, const std::string& path,
                                   const LogRequest& request) const override {
    // A log may hold several streams: the request says which is wanted now.
    if (request.stream != StreamKind::odometry && request.stream != StreamKind::gnss)
      throw InputError(path + ": line_log holds odometry and fixes only");
    const char wanted = request.stream == StreamKind::odometry ? 'O' : 'F';
    LogData data;
    for (std::size_t number = 1; !text.empty(); ++number) {
      const std::string_view line = text.substr(0, text.find('\n'));
      text.remove_prefix(std::min(line.size() + 1, text.size()));
      if (!line.starts_with(wanted)) continue;
      ++data.records;
      if (add_sample(line, number, request, data)) continue;
      // What should have been a sample is counted, and the first few are shown; the run goes on.
      if (++data.corrupt <= 5)
        data.corrupt_examples.push_back(path + ":" + std::to_string(number) + ":1: not a record of line_log");
    }
    if (data.records == 0) throw InputError(path + ": no record begins with " + wanted);
    if (data.corrupt == data.records) throw InputError(data.corrupt_examples.front());
    return data;
  }
};

static void register_types(TypeRegistry& registry) {
  static const LineLog reader;
  registry.add_log_reader({"line_log", "lines of a letter and numbers: O odometry, F fixes", &reader});
}
WAYMARK_PLUGIN(line_log, "1.0.0", register_types);
