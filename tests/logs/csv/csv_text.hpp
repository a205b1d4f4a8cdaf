/// Tables of tests, read as logs.
#pragma once

#include <string_view>

#include <waymark/core/drive/log_reader.hpp>
#include <waymark/formats/logs/detail/csv/csv_log.hpp>

namespace waymark_test {

/// Returns a request for columns of default names; fixes without an accuracy have a sigma of 1 m.
inline waymark::LogRequest csv_request(waymark::StreamKind stream) {
  waymark::LogRequest request;
  request.stream = stream;
  request.default_sigma_m = 1;
  return request;
}

inline waymark::LogData read_csv(std::string_view text, const waymark::LogRequest& request) {
  return waymark::formats::CsvLogReader().read(text, "log.csv", request);
}

}  // namespace waymark_test
