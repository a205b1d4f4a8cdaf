/// Reports of gpsd for tests, and functions that read them.
#pragma once

#include <catch2/catch.hpp>

#include <numbers>
#include <string>
#include <string_view>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/gpsd/gpsd_json.hpp>
#include <waymark/formats/text/iso8601.hpp>
#include <waymark/formats/text/text_file.hpp>

#include "logs/log_pieces.hpp"
#include "support/skip.hpp"

namespace waymark_test::gpsd_samples {

using namespace waymark;
using namespace waymark::formats;
using Catch::Matchers::Message;

inline LogRequest utc_fixes() {
  LogRequest request;
  request.time_scale = TimeScale::utc;
  return request;
}

inline LogData read(std::string_view text, const LogRequest& request = utc_fixes()) {
  return GpsdJsonReader().read(text, "log.json", request);
}

inline constexpr const char* kFix =
    R"({"class":"TPV","mode":3,"time":"2005-06-09T14:34:45.280Z","lat":46.5,"lon":7.5,"altHAE":1391.3,)"
    R"("epx":4,"epy":6,"eph":10,"track":90,"epd":20,"speed":5,"eps":3})";

/// Returns the text of a log in the shared data; empty if the case is skipped, because the log is
/// missing.
inline std::string shared_log(const std::string& name) {
  const auto path = waymark_test::shared_data("logs/gpsd/" + name);
  return path ? read_text_file(*path) : "";
}

}  // namespace waymark_test::gpsd_samples
