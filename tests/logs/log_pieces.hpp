/// A log given to its reader in pieces gives what it gives at once.
#pragma once

#include <string>
#include <string_view>

#include <catch2/catch.hpp>

#include <waymark/core/log_reader.hpp>

namespace waymark_test {

inline waymark::LogData read_in_pieces_of(std::size_t length, const waymark::LogReader& reader,
                                          std::string_view text, const std::string& path,
                                          const waymark::LogRequest& request) {
  const auto decoder = reader.open(path, request);
  for (; !text.empty(); text.remove_prefix(std::min(length, text.size())))
    decoder->take(text.substr(0, length));
  decoder->finish();
  return decoder->data();
}

inline void check_same(const waymark::LogData& a, const waymark::LogData& b) {
  CHECK(a.notes == b.notes);
  CHECK(a.kinds == b.kinds);
  CHECK(a.corrupt_examples == b.corrupt_examples);
  CHECK(a.records == b.records);
  CHECK(a.without_fix == b.without_fix);
  CHECK(a.corrupt == b.corrupt);
  REQUIRE(a.odometry.size() == b.odometry.size());
  for (std::size_t i = 0; i < a.odometry.size(); ++i) {
    CHECK(a.odometry[i].stamp == b.odometry[i].stamp);
    CHECK(a.odometry[i].speed_mps == b.odometry[i].speed_mps);
    CHECK(a.odometry[i].yaw_rate_radps == b.odometry[i].yaw_rate_radps);
  }
  REQUIRE(a.fixes.size() == b.fixes.size());
  for (std::size_t i = 0; i < a.fixes.size(); ++i) {
    CHECK(a.fixes[i].stamp == b.fixes[i].stamp);
    CHECK(a.fixes[i].latitude_deg == b.fixes[i].latitude_deg);
    CHECK(a.fixes[i].longitude_deg == b.fixes[i].longitude_deg);
    CHECK(a.fixes[i].covariance_en == b.fixes[i].covariance_en);
    CHECK(a.fixes[i].course_rad == b.fixes[i].course_rad);
    CHECK(a.fixes[i].speed_mps == b.fixes[i].speed_mps);
    CHECK(a.fixes[i].line == b.fixes[i].line);
  }
  REQUIRE(a.truth.size() == b.truth.size());
  for (std::size_t i = 0; i < a.truth.size(); ++i) {
    CHECK(a.truth[i].stamp == b.truth[i].stamp);
    CHECK(a.truth[i].latitude_deg == b.truth[i].latitude_deg);
    CHECK(a.truth[i].heading_rad == b.truth[i].heading_rad);
  }
}

/// Byte by byte, and in pieces of 7.
inline void check_pieces(const waymark::LogReader& reader, std::string_view text, const std::string& path,
                         const waymark::LogRequest& request) {
  const waymark::LogData whole = read_in_pieces_of(text.size() + 1, reader, text, path, request);
  check_same(read_in_pieces_of(1, reader, text, path, request), whole);
  check_same(read_in_pieces_of(7, reader, text, path, request), whole);
}

}  // namespace waymark_test
