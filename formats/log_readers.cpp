#include <waymark/formats/log_readers.hpp>

#include <array>

#include <waymark/formats/csv_log.hpp>
#include <waymark/formats/gpsd_json.hpp>

namespace waymark {

std::span<const NamedLogReader> builtin_log_readers() {
  static const CsvLogReader csv;
  static const GpsdJsonReader gpsd_json;
  static const std::array<NamedLogReader, 2> readers{
      {{"csv", &csv, "separated values with a column map: odometry, gnss, truth"},
       {"gpsd_json", &gpsd_json, "gpsd's JSON reports (TPV): gnss, truth"}}};
  return readers;
}

const LogReader* builtin_log_reader(std::string_view name) {
  for (const NamedLogReader& entry : builtin_log_readers()) {
    if (entry.name == name) return entry.reader;
  }
  return nullptr;
}

}  // namespace waymark
