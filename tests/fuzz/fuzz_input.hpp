/// Interprets the bytes of a fuzzer: the first four say how a log is read, the rest is the log.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <waymark/core/drive/log_reader.hpp>

namespace waymark_fuzz {

/// A log, and how it is to be read. Layout of the leading bytes (bit 0 is the least):
/// | byte | bits | meaning |
/// |---|---|---|
/// | 0 | 0-1 | stream, modulo those the reader gives |
/// |   | 2-3 | pieces of 1, 7, 64 bytes or the whole |
/// |   | 4   | checksums are made right first (UBX, NMEA, NovAtel) |
/// |   | 5-7 | columns: a variant (CSV, CAN, UBX), how the time stamps are made (KITTI), or where ephemerides are |
/// | 1 | 0-2 | meaning of accuracy figures |
/// |   | 3   | a default sigma of 5 m |
/// |   | 4   | a range error of 4 m |
/// |   | 5-6 | time scale |
/// | 2 | 0-1 | GPS week 0, 1, 2200, 10000 |
/// |   | 2   | a date for logs without one |
/// |   | 3-4 | time offset 0, 0.25, -7.5, 1e9 s |
/// |   | 5-7 | separator |
/// | 3 | all | free: the time between KITTI's stamps |
struct FuzzInput {
  waymark::LogRequest request;
  std::size_t piece = 0;  ///< length; 0: the whole at once
  std::string log;
};

/// @param reader name of the reader; it decides which streams and columns are possible
[[nodiscard]] FuzzInput fuzz_input(std::string_view reader, const std::uint8_t* bytes, std::size_t size);

/// Returns the DBC that the candump fuzzer uses.
[[nodiscard]] const std::string& fuzz_dbc();

/// Sets the columns of a CAN log to signals of fuzz_dbc().
void set_can_columns(waymark::LogRequest& request, unsigned variant);

}  // namespace waymark_fuzz
