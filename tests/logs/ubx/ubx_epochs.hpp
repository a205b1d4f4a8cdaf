/// Epochs of UBX messages for tests, and functions that read them.
#pragma once

#include <catch2/catch.hpp>

#include <cmath>
#include <iostream>
#include <limits>
#include <numbers>
#include <string>
#include <string_view>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/channels.hpp>
#include <waymark/formats/logs/detail/ubx/ubx.hpp>
#include <waymark/formats/text/text_file.hpp>

#include "logs/ubx/ubx_bytes.hpp"
#include "support/paths.hpp"

namespace waymark_test::ubx_samples {

using namespace waymark;
using namespace waymark::formats;
using Catch::Matchers::Message;
using Notes = std::vector<std::string>;

inline LogData read(std::string_view bytes, const LogRequest& request = {}) {
  return UbxReader().read(bytes, "log.ubx", request);
}

inline std::string pvt_frame(const UbxBytes& pvt) {
  return ubx_frame(0x0107, pvt.bytes());
}

/// Returns the content of a log for which read() would throw because it has no samples.
inline LogData decode(std::string_view bytes, const LogRequest& request = {}) {
  const auto decoder = UbxReader().open("log.ubx", request);
  decoder->take(bytes);
  decoder->finish();
  return decoder->data();
}

inline bool has_note(const LogData& data, const std::string& text) {
  for (const std::string& note : data.notes) {
    if (note == "log.ubx: " + text) return true;
  }
  return false;
}

}  // namespace waymark_test::ubx_samples
