/// Real raw measurements of the shared data, read by the reader "rinex" and as others exported them.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include <waymark/core/drive/log_reader.hpp>

namespace waymark_test {

/// The columns of the plugin gnss_raw.
[[nodiscard]] std::vector<waymark::SensorColumn> raw_gnss_columns();

/// Reads an observation file with navigation files (names below the shared data).
[[nodiscard]] waymark::LogData read_rinex(const std::string& observations,
                                          const std::vector<std::string>& navigation);

/// Tenths of a second of the week, system, number.
using RawKey = std::tuple<long, int, int>;

/// The rows of a table by their keys. @param table with the columns of raw_gnss_columns()
[[nodiscard]] std::map<RawKey, std::vector<double>> rows_by_key(const waymark::SensorTable& table, int week);

/// Returns the words of the lines of a file, split at blanks and commas.
[[nodiscard]] std::vector<std::vector<std::string>> words_of_lines(const std::string& path);

}  // namespace waymark_test
