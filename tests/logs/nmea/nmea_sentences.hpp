/// NMEA sentences for tests, and functions that read them.
#pragma once

#include <catch2/catch.hpp>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <numbers>
#include <string>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/nmea/nmea.hpp>
#include <waymark/formats/text/iso8601.hpp>
#include <waymark/formats/text/text_file.hpp>

#include "logs/log_pieces.hpp"
#include "support/paths.hpp"

namespace waymark_test::nmea_samples {

using namespace waymark;
using namespace waymark::formats;
using Catch::Matchers::Message;

/// Returns a line with `$` and the checksum as the standard defines it.
inline std::string line(const std::string& body) {
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  char tail[8];
  std::snprintf(tail, sizeof tail, "*%02X\r\n", sum);
  return "$" + body + tail;
}

inline std::string rmc(const std::string& time, const std::string& date = "010409") {
  return line(fmt::format("GPRMC,{},A,4810.8509,N,01133.9095,E,10,90,{},,,A", time, date));
}
inline std::string gga(const std::string& time) {
  return line(fmt::format("GPGGA,{},4810.8509,N,01133.9095,E,1,04,2.5,500.5,M,46.5,M,,", time));
}

inline LogRequest utc() {
  LogRequest request;
  request.time_scale = TimeScale::utc;
  request.default_sigma_m = 10;
  return request;
}

inline LogData read(const std::string& text, const LogRequest& request = utc()) {
  return NmeaReader().read(text, "log.nmea", request);
}

inline std::int64_t at(const char* iso) {
  return stamp_from_iso8601(iso).value().nanoseconds;
}

inline bool noted(const LogData& data, const std::string& note) {
  return std::find(data.notes.begin(), data.notes.end(), "log.nmea: " + note) != data.notes.end();
}

/// Returns the only error of a text.
inline std::string complaint(const std::string& text, const LogRequest& request = utc()) {
  const LogData data = read(rmc("000000") + text + rmc("000009"), request);
  REQUIRE(data.corrupt_examples.size() == 1);
  return data.corrupt_examples[0];
}

}  // namespace waymark_test::nmea_samples
