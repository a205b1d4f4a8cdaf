#include "logs/rinex/shared_raw.hpp"

#include <cmath>
#include <sstream>

#include <waymark/formats/logs/log_file.hpp>
#include <waymark/formats/logs/log_readers.hpp>
#include <waymark/formats/text/text_file.hpp>

#include "support/paths.hpp"

namespace waymark_test {

using namespace waymark;

std::vector<SensorColumn> raw_gnss_columns() {
  std::vector<SensorColumn> columns;
  for (const char* name : {"system", "satellite", "pseudorange", "range_rate", "satellite_x", "satellite_y",
                           "satellite_z", "satellite_vx", "satellite_vy", "satellite_vz", "elevation", "cn0"})
    columns.push_back({name, "1", "", false, ""});
  return columns;
}

LogData read_rinex(const std::string& observations, const std::vector<std::string>& navigation) {
  const std::string root = shared_data_dir().string() + "/";
  LogRequest request;
  request.stream = StreamKind::sensor;
  request.readings = raw_gnss_columns();
  for (const std::string& file : navigation)
    request.companions["navigation"].push_back(formats::read_companion(root + file));
  return formats::read_log_file(*formats::builtin_log_reader("rinex"), root + observations, request);
}

std::map<RawKey, std::vector<double>> rows_by_key(const SensorTable& table, int week) {
  std::map<RawKey, std::vector<double>> rows;
  for (std::size_t row = 0; row < table.size(); ++row) {
    const double second = table.stamps[row].seconds() - week * 604'800.0;
    std::vector<double> values;
    for (std::size_t c = 0; c < table.columns; ++c) values.push_back(table.at(row, c));
    rows[{std::lround(second * 10), static_cast<int>(values[0]), static_cast<int>(values[1])}] = values;
  }
  return rows;
}

std::vector<std::vector<std::string>> words_of_lines(const std::string& path) {
  std::vector<std::vector<std::string>> lines;
  std::istringstream text(formats::read_text_file(path));
  for (std::string line; std::getline(text, line);) {
    for (char& c : line)
      if (c == ',') c = ' ';
    std::istringstream words(line);
    lines.emplace_back();
    for (std::string word; words >> word;) lines.back().push_back(word);
  }
  return lines;
}

}  // namespace waymark_test
