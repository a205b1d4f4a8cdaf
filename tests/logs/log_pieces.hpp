/// Checks that a log in pieces gives the same result as the whole log.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/core/drive/log_reader.hpp>

namespace waymark_test {

/// Takes the fixes out after every piece, as a caller with bounded memory does, and puts them
/// back at the end.
inline waymark::LogData read_in_pieces_of(std::size_t length, const waymark::LogReader& reader,
                                          std::string_view text, const std::string& path,
                                          const waymark::LogRequest& request) {
  const auto decoder = reader.open(path, request);
  std::vector<waymark::GeodeticFix> fixes;
  const auto take_out = [&] {
    auto& found = decoder->data().fixes;
    fixes.insert(fixes.end(), found.begin(), found.end());
    found.clear();
  };
  for (; !text.empty(); text.remove_prefix(std::min(length, text.size()))) {
    decoder->take(text.substr(0, length));
    take_out();
  }
  decoder->finish();
  take_out();
  decoder->data().fixes = std::move(fixes);
  return decoder->data();
}

/// Compares bit by bit, so that NaN equals itself.
inline bool same_number(double a, double b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

inline bool same_fix(const waymark::GeodeticFix& a, const waymark::GeodeticFix& b) {
  return a.stamp == b.stamp && a.latitude_deg == b.latitude_deg && a.longitude_deg == b.longitude_deg &&
         same_number(a.height_m, b.height_m) && a.covariance_en == b.covariance_en &&
         a.course_rad == b.course_rad && a.course_sigma_rad == b.course_sigma_rad &&
         a.speed_mps == b.speed_mps && a.speed_sigma_mps == b.speed_sigma_mps && a.source == b.source &&
         a.line == b.line;
}

inline bool same_truth(const waymark::GeodeticTruth& a, const waymark::GeodeticTruth& b) {
  return a.stamp == b.stamp && a.latitude_deg == b.latitude_deg && a.longitude_deg == b.longitude_deg &&
         same_number(a.height_m, b.height_m) && a.heading_rad == b.heading_rad;
}

inline bool same_odometry(const waymark::OdometrySample& a, const waymark::OdometrySample& b) {
  return a.stamp == b.stamp && a.speed_mps == b.speed_mps && a.yaw_rate_radps == b.yaw_rate_radps;
}

inline bool same_clocks(const waymark::ClockPair& a, const waymark::ClockPair& b) {
  return a.logged == b.logged && a.told == b.told;
}

/// Returns the first index at which two rows of samples differ, or the common length if
/// they do not.
template <typename Rows, typename Same>
std::size_t same_until(const Rows& a, const Rows& b, Same same) {
  const auto [end, other] = std::mismatch(a.begin(), a.end(), b.begin(), b.end(), same);
  return static_cast<std::size_t>(end - a.begin());
}

inline void check_same(const waymark::LogData& a, const waymark::LogData& b) {
  CHECK(a.notes == b.notes);
  CHECK(a.kinds == b.kinds);
  CHECK(a.corrupt_examples == b.corrupt_examples);
  CHECK(a.records == b.records);
  CHECK(a.without_fix == b.without_fix);
  CHECK(a.corrupt == b.corrupt);
  CHECK(a.odometry.size() == b.odometry.size());
  CHECK(same_until(a.odometry, b.odometry, same_odometry) == b.odometry.size());
  CHECK(a.fixes.size() == b.fixes.size());
  CHECK(same_until(a.fixes, b.fixes, same_fix) == b.fixes.size());
  CHECK(a.truth.size() == b.truth.size());
  CHECK(same_until(a.truth, b.truth, same_truth) == b.truth.size());
  CHECK(a.clocks.size() == b.clocks.size());
  CHECK(same_until(a.clocks, b.clocks, same_clocks) == b.clocks.size());
  CHECK(a.readings.stamps == b.readings.stamps);
  CHECK(a.readings.values.size() == b.readings.values.size());
  CHECK(same_until(a.readings.values, b.readings.values, same_number) == b.readings.values.size());
}

/// Reads byte by byte, and in pieces of 7. @return the log read at once
inline waymark::LogData check_pieces(const waymark::LogReader& reader, std::string_view text,
                                     const std::string& path, const waymark::LogRequest& request) {
  waymark::LogData whole = read_in_pieces_of(text.size() + 1, reader, text, path, request);
  check_same(read_in_pieces_of(1, reader, text, path, request), whole);
  check_same(read_in_pieces_of(7, reader, text, path, request), whole);
  return whole;
}

}  // namespace waymark_test
