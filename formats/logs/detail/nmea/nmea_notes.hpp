/// The notes of the NMEA reader: its assumptions, and the sentences it skipped.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// Counts of one log.
struct NmeaCounts {
  std::size_t not_sentences = 0;
  std::size_t without_checksum = 0;
  std::size_t other_wrong_checksums = 0;
  std::size_t without_time = 0;
  std::size_t without_satellites = 0;
  std::size_t from_gst = 0;
  std::size_t from_ellipse = 0;
  std::size_t ellipse_disagrees = 0;
  std::size_t above_sea_level = 0;
  std::size_t dead_reckoning = 0;
  std::size_t simulated = 0;
  std::size_t leap_seconds = 0;
  std::size_t midnights = 0;
  std::size_t dated_backwards = 0;
  std::size_t decimals = 0;  ///< the largest number in any position
  std::size_t fixes = 0;
  bool log_has_date = false;
};

/// Returns one sentence for each fact worth a note, except those that all logs of positions share
/// (PositionStream).
[[nodiscard]] std::vector<std::string> nmea_notes(const NmeaCounts& counts, const LogRequest& request);

}  // namespace waymark::formats
